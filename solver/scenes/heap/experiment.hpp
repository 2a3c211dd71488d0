// The heap as it runs: settling in the tube, lifting, and coming to rest.
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/observables/heap.hpp"
#include "solver/scenes/heap/study.hpp"
#include "solver/scenes/scene.hpp"

namespace grainsweep::heap {

class Experiment final : public Scene {
public:
    Experiment(const Study& study, std::uint64_t seed, const dem::Method& method);

    void advance(double until) override;
    int use_threads(int count) override { return engine_->set_threads(count); }
    void observe(Observations& into) const override;
    [[nodiscard]] double time() const override { return study_.time_step * static_cast<double>(step_); }
    [[nodiscard]] bool finished() const override { return ended_; }
    [[nodiscard]] double progress() const override {
        return ended_ ? 1 : static_cast<double>(step_) / static_cast<double>(study_.last_step);
    }
    [[nodiscard]] Health health() const override { return {engine_->fault()}; }
    [[nodiscard]] double particle_steps() const override { return engine_->work().particle_steps; }
    void save(Bytes& into) const override;
    void restore(std::span<const std::byte> from) override;
    [[nodiscard]] Snapshot snapshot() const override;
    [[nodiscard]] double picture_focus() const override {
        return study_.time_step * static_cast<double>(study_.settle_steps);
    }

private:
    /// Looks whether the heap is at rest below the tube.
    void look();

    Study study_;
    dem::Domain domain_;  // for pictures, as the walls
    std::vector<dem::Wall> walls_;
    std::int64_t glued_ = 0;
    std::unique_ptr<dem::Engine> engine_;
    std::int64_t step_ = 0;
    bool ended_ = false;
    dem::State state_;  // scratch
};

}  // namespace grainsweep::heap
