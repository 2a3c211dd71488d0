// The hopper as it runs: settling on the closed opening, then the outflow, frame by frame.
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/observables/outflow.hpp"
#include "solver/scenes/hopper/study.hpp"
#include "solver/scenes/scene.hpp"

namespace grainsweep::hopper {

class Experiment final : public Scene {
public:
    Experiment(const Study& study, std::uint64_t seed, const dem::Method& method);

    void advance(double until) override;
    int use_threads(int count) override { return engine_->set_threads(count); }
    void observe(Observations& into) const override;
    [[nodiscard]] double time() const override { return study_.time_step * static_cast<double>(step_); }
    [[nodiscard]] bool finished() const override { return ended_; }
    [[nodiscard]] double progress() const override;
    [[nodiscard]] Health health() const override { return {engine_->fault()}; }
    [[nodiscard]] double particle_steps() const override { return engine_->work().particle_steps; }
    void save(Bytes& into) const override;
    void restore(std::span<const std::byte> from) override;
    [[nodiscard]] Snapshot snapshot() const override;
    [[nodiscard]] double picture_focus() const override {
        return study_.time_step * static_cast<double>(study_.settle_steps);
    }

private:
    [[nodiscard]] bool is_open() const { return !outflow_.empty(); }
    void open();
    void take_frame();
    /// Whether nothing has left for so long that the flow has ceased.
    [[nodiscard]] bool ceased() const;
    void observe_rate(Observations& into) const;

    Study study_;
    dem::Domain domain_;          // for pictures
    std::vector<double> radius_;  // by id
    double mass_ = 0, mean_diameter_ = 0;
    std::unique_ptr<dem::Engine> engine_;
    std::int64_t step_ = 0;
    bool ended_ = false;
    double bulk_fraction_ = 0;  // NaN: too little powder
    double over_opening_ = 0;   // solid fraction over the opening at the last frame
    std::vector<observables::Outflow> outflow_;
    dem::State state_;  // scratch
};

}  // namespace grainsweep::hopper
