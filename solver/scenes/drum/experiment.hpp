// The rotating drum as it runs: powder falling into the turning drum, then frames at equal times.
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/observables/turned_bed.hpp"
#include "solver/scenes/drum/study.hpp"
#include "solver/scenes/scene.hpp"

namespace grainsweep::drum {

class Experiment final : public Scene {
public:
    Experiment(const Study& study, std::uint64_t seed, const dem::Method& method);

    void advance(double until) override;
    int use_threads(int count) override { return engine_->set_threads(count); }
    void observe(Observations& into) const override;
    [[nodiscard]] double time() const override { return study_.time_step * static_cast<double>(step_); }
    [[nodiscard]] bool finished() const override { return step_ == study_.last_step(); }
    [[nodiscard]] double progress() const override {
        return finished() ? 1 : static_cast<double>(step_) / static_cast<double>(study_.last_step());
    }
    [[nodiscard]] Health health() const override { return {engine_->fault()}; }
    [[nodiscard]] double particle_steps() const override { return engine_->work().particle_steps; }
    void save(Bytes& into) const override;
    void restore(std::span<const std::byte> from) override;
    [[nodiscard]] Snapshot snapshot() const override;
    [[nodiscard]] double picture_focus() const override { return study_.turning_time; }

private:
    [[nodiscard]] std::int64_t frames_taken() const { return static_cast<std::int64_t>(angle_.size()); }
    /// Work of drum and plates on the powder so far, J.
    [[nodiscard]] double work_done() const;
    void take_frame();
    void observe_angles(Observations& into) const;
    void observe_flow(Observations& into) const;
    void observe_cover(Observations& into) const;

    Study study_;
    dem::Domain domain_;            // for pictures, as the walls
    std::vector<dem::Wall> walls_;  // drum and plates
    std::unique_ptr<dem::Engine> engine_;
    std::int64_t step_ = 0;

    std::vector<double> angle_;  // by frame, degrees
    observables::SolidFraction solid_;
    observables::SectionFlow flow_;
    observables::Cover cover_;
    double wall_layer_sum_ = 0;  // m/s, over frames with a layer at the wall
    std::int64_t wall_layer_frames_ = 0;
    double coordination_sum_ = 0, energy_sum_ = 0;
    double rolling_sum_ = 0;  // of the moments about the axis that resist rolling at the walls, N m
    double first_work_ = 0;   // at the first frame
    dem::State state_;        // scratch of take_frame()
    std::vector<dem::ContactForce> contacts_;
};

}  // namespace grainsweep::drum
