// The two kinds of run of a thermovibration case.
//
// Live: fluid and particles together from t = 0.
// Carried: one-way particles are released into a flow that has become periodic. The flow is computed once, stored as
// harmonics (an artefact shared by all cases of the same fluid), and always evaluated from the harmonics.
#pragma once

#include "solver/coupling/march.hpp"
#include "solver/coupling/periodic_flow.hpp"
#include "solver/coupling/visit_order.hpp"
#include "solver/scenes/scene.hpp"
#include "solver/scenes/thermovibration/levels.hpp"
#include "solver/scenes/thermovibration/record.hpp"

#include <optional>
#include <string>
#include <utility>

namespace grainsweep::thermovibration {

/// Returns the fault of the state after a step; empty: none. Faults are Courant numbers above 1, NaN, particles that
/// cross more than a cell in a step, and cells with more particles than spheres can fill.
[[nodiscard]] std::string fault(const flow::Flow<flow::Boussinesq>& fluid, double time);
[[nodiscard]] std::string fault(const coupling::Cloud& cloud, double time_step, double cell, double time);
[[nodiscard]] std::string fault(const coupling::SolidsVolume& solids, const flow::Grid& grid, double time);
/// Returns the steps between two checks of fluid and fractions (also made before samples; particles are checked in
/// every step). It is about eight, without a common divisor with the steps of a period, so that all phases of the
/// vibration are checked in turn.
[[nodiscard]] std::int64_t watch_interval(std::int64_t steps_per_period);

/// Returns how many of `count` threads (0: one for each core) are useful: with too few cells per thread, waiting costs
/// more than the threads save.
[[nodiscard]] int threads_for(const flow::Grid& grid, int count);

class Live final : public Scene {
public:
    Live(const Question& question, std::uint64_t seed);

    void advance(double until) override;
    int use_threads(int count) override;
    void observe(Observations& into) const override { record_.observe(into); }
    [[nodiscard]] double time() const override { return coupled_->fluid().time(); }
    [[nodiscard]] bool finished() const override { return steps() >= question_.total_steps(); }
    [[nodiscard]] double progress() const override {
        return static_cast<double>(steps()) / static_cast<double>(question_.total_steps());
    }
    [[nodiscard]] Health health() const override { return {fault_}; }
    [[nodiscard]] double particle_steps() const override {
        return static_cast<double>(steps()) * static_cast<double>(question_.particles);
    }
    void save(Bytes& into) const override;
    void restore(std::span<const std::byte> from) override;
    [[nodiscard]] Snapshot snapshot() const override;
    [[nodiscard]] double picture_period() const override { return question_.steady_force() ? 0 : question_.period(); }

private:
    [[nodiscard]] std::int64_t steps() const { return coupled_->fluid().steps(); }
    void step();

    Question question_;
    Record record_;
    FlowMeans means_;  // of the last window, which may be incomplete
    BudgetMeans budget_;
    std::unique_ptr<Coupled> coupled_;
    Slabs slabs_;
    std::int64_t watch_;
    std::string fault_;
};

/// Run of a fluid alone until its flow is periodic; then one period is stored.
///
/// The criterion is the mean velocity M of one period in every twenty. Conduction relaxes as exp(-pi^2 t), so the
/// remaining change is about |M - M'| / (pi^2 20 P). The flow is periodic if this is below 2 % of |M| or 1e-5 of the
/// rms velocity, twice in succession.
class SpinUp {
public:
    explicit SpinUp(const Question& question);

    /// Sets the threads that compute a step; no bit depends on their number.
    void use(const Slabs& slabs) { fluid_.use(slabs); }
    void step();
    [[nodiscard]] double time() const { return fluid_.time(); }
    [[nodiscard]] bool periodic() const { return stage_ == Stage::stored; }
    [[nodiscard]] const std::string& fault() const { return fault_; }
    [[nodiscard]] const FlowMeans& means() const { return means_; }
    [[nodiscard]] const flow::FaceVectors& velocity() const { return fluid_.velocity(); }
    [[nodiscard]] coupling::PeriodicFlow stored() const { return {fluid_.grid(), stored_}; }

    void save(std::vector<std::byte>& into) const;
    void restore(std::span<const std::byte>& from);

private:
    enum class Stage : std::int64_t { settling, storing, stored };
    void compare();

    Question question_;
    flow::Flow<flow::Boussinesq> fluid_;
    flow::FaceVectors velocity_, acceleration_;  // scratch
    flow::FaceVectors mean_, previous_mean_;
    double mean_square_ = 0;  // of the velocity in the period that is judged
    std::int64_t passes_ = 0;
    Stage stage_ = Stage::settling;
    FlowMeans means_;
    coupling::PeriodSum stored_;
    std::string fault_;
};

/// Particles in a stored flow.
struct CarriedCloud {
    explicit CarriedCloud(const Question& question, std::uint64_t seed)
        : grid(question.flow_grid()),
          walls(question.walls()),
          motion(question.sphere(), question.step()),
          particles(question.cloud(seed)),
          flow(grid) {}

    flow::Grid grid;
    coupling::Walls walls;
    coupling::Motion<Drag> motion;
    coupling::Cloud particles;
    coupling::VisitOrder order;
    coupling::PeriodicFlow flow;
    Slabs slabs;
};

/// Function that advances such a cloud by a step; `phase` and `vibration` in the middle of the step.
using CarriedStep = void(CarriedCloud& cloud, double phase, double vibration);
template <class Level, class Kernel>
void carry(CarriedCloud& cloud, double phase, double vibration) {
    const double half = 0.5 * cloud.motion.time_step(), c = std::cos(phase), s = std::sin(phase);
    const std::array<double, coupling::PeriodicFlow::terms> basis{1, c, s, c * c - s * s, 2 * s * c};
    const auto middle = [&](std::size_t p) {
        coupling::Vec3 x = cloud.particles.position[p];
        for (std::size_t d = 0; d < 3; ++d) x[d] += half * cloud.particles.velocity[p][d];
        return cloud.walls.clipped(x);
    };
    using Stencil = coupling::Stencil<Kernel>;
    coupling::march(
        cloud.particles, cloud.motion, cloud.walls, vibration, cloud.order.of(cloud.particles, cloud.grid),
        [&](std::size_t p) {
            if constexpr (Level::mirrored)
                return Stencil(cloud.grid, cloud.walls.periodic, Level::below(middle(p)));
            else
                return Stencil(cloud.grid, cloud.walls.periodic, middle(p));
        },
        [&](std::size_t p, const Stencil& stencil) {
            coupling::Surroundings around = cloud.flow.at(stencil, basis);
            if constexpr (Level::mirrored) Level::turn(middle(p), around);
            return around;
        },
        [](std::size_t, const coupling::Vec3&) {}, cloud.slabs);
}

/// Returns the step function of a case's particles (levels.cpp).
[[nodiscard]] CarriedStep* carried_step(const Question& question);

class Carried final : public Scene {
public:
    Carried(const Question& question, std::uint64_t seed, Artefacts& artefacts, CarriedStep* carry_step);

    void advance(double until) override;
    int use_threads(int count) override;
    void observe(Observations& into) const override { record_.observe(into); }
    /// Returns the time of the particles, plus the time until the flow was periodic if this run computed the flow.
    [[nodiscard]] double time() const override {
        return (spin_up_ ? spin_up_->time() : spun_) + static_cast<double>(steps_) * question_.step();
    }
    [[nodiscard]] bool finished() const override { return !spin_up_ && steps_ >= question_.total_steps(); }
    [[nodiscard]] double progress() const override;
    [[nodiscard]] Health health() const override { return {fault_}; }
    [[nodiscard]] double particle_steps() const override {
        return static_cast<double>(steps_) * static_cast<double>(question_.particles);
    }
    void save(Bytes& into) const override;
    void restore(std::span<const std::byte> from) override;
    /// Returns a picture without temperature, which the stored flow does not contain.
    [[nodiscard]] Snapshot snapshot() const override;
    [[nodiscard]] double picture_period() const override { return question_.period(); }

private:
    void settle();
    [[nodiscard]] bool received(std::span<const std::byte> contents);
    void receive(std::span<const std::byte> contents);
    void step();

    Question question_;
    Artefacts& artefacts_;
    CarriedCloud cloud_;
    CarriedStep* carry_;
    Record record_;
    std::optional<SpinUp> spin_up_;  // only until the periodic flow is known
    std::int64_t steps_ = 0;         // of the particles
    double spun_ = 0;
    std::string fault_;
};

}  // namespace grainsweep::thermovibration
