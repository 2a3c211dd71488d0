// The two ways a thermovibration case is run.
//
// Live: fluid and particles together from t = 0.
// Carried: one-way particles released into a flow that has become periodic. The flow is found once, stored as
// harmonics (an artefact shared by all cases of the same fluid) and always read back from that representation.
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

/// Why the state is not sound after a step: Courant numbers above 1, values that are no numbers, particles that
/// cross more than a cell in a step, cells fuller of particles than spheres can fill them. Empty: none.
[[nodiscard]] std::string fault(const flow::Flow<flow::Boussinesq>& fluid, double time);
[[nodiscard]] std::string fault(const coupling::Cloud& cloud, double time_step, double cell, double time);
[[nodiscard]] std::string fault(const coupling::SolidsVolume& solids, const flow::Grid& grid, double time);
/// Particles are watched after every step, fluid and fractions every so many (and before what they are sampled for):
/// about eight, with no divisor in common with those of a period, so that all phases of the vibration come up in turn.
[[nodiscard]] std::int64_t watch_interval(std::int64_t steps_per_period);

/// How many of `count` threads (0: one for each core) have enough to do: with fewer cells for each of them, waiting for
/// one another costs more than it saves.
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
    FlowMeans means_;  // of the last window, as far as it has come
    BudgetMeans budget_;
    std::unique_ptr<Coupled> coupled_;
    Slabs slabs_;
    std::int64_t watch_;
    std::string fault_;
};

/// Runs a fluid alone until it repeats itself, then stores one period.
///
/// Judged by the mean velocity M over one period in every twenty: conduction relaxes as exp(-pi^2 t), so what is still
/// to come is about |M - M'| / (pi^2 20 P). Periodic when that is below 2 % of |M| or 1e-5 of the rms velocity, twice
/// in succession.
class SpinUp {
public:
    explicit SpinUp(const Question& question);

    /// Threads that compute a step from now on; no bit depends on their number.
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
    double mean_square_ = 0;  // of the velocity over the period being judged
    std::int64_t passes_ = 0;
    Stage stage_ = Stage::settling;
    FlowMeans means_;
    coupling::PeriodSum stored_;
    std::string fault_;
};

/// Particles in a stored flow that they do not change.
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

/// Advances it by a step; `phase` and `vibration` in the middle of the step.
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

/// The step of a case's particles (levels.cpp).
[[nodiscard]] CarriedStep* carried_step(const Question& question);

class Carried final : public Scene {
public:
    Carried(const Question& question, std::uint64_t seed, Artefacts& artefacts, CarriedStep* carry_step);

    void advance(double until) override;
    int use_threads(int count) override;
    void observe(Observations& into) const override { record_.observe(into); }
    /// The time the flow took to become periodic, if it was found here, and the time of the particles since.
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
    /// Without temperature, which the stored flow has not.
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
    std::optional<SpinUp> spin_up_;  // only while the flow is not yet known
    std::int64_t steps_ = 0;         // of the particles
    double spun_ = 0;
    std::string fault_;
};

}  // namespace grainsweep::thermovibration
