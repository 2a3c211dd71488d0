// The two ways a thermovibration case is run.
//
// Live: fluid and particles together from t = 0.
// Carried: one-way particles released into a flow that has become periodic. The flow is found once, stored as
// harmonics (an artefact shared by all cases of the same fluid) and always read back from that representation.
#pragma once

#include "solver/coupling/march.hpp"
#include "solver/coupling/periodic_flow.hpp"
#include "solver/coupling/solids_volume.hpp"
#include "solver/coupling/suspension.hpp"
#include "solver/scenes/scene.hpp"
#include "solver/scenes/thermovibration/picture.hpp"
#include "solver/scenes/thermovibration/record.hpp"

#include <optional>
#include <string>
#include <utility>

namespace grainsweep::thermovibration {

using Drag = coupling::SchillerNaumann;

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

/// Together: the coupled system, a Suspension or a DenseSuspension.
template <class Together>
class Live final : public Scene {
public:
    Live(const Question& question, Together together)
        : question_(question), record_(question), suspension_(std::move(together)) {
        record_.sample(0, suspension_.cloud());
    }

    void advance(double until) override {
        while (time() < until && !finished() && fault_.empty()) step();
    }
    int use_threads(int count) override {
        const int wanted = threads_for(suspension_.fluid().grid(), count);
        if (wanted != slabs_.count()) suspension_.use(slabs_ = Slabs(wanted));
        return wanted;
    }
    void observe(Observations& into) const override { record_.observe(into); }
    [[nodiscard]] double time() const override { return suspension_.fluid().time(); }
    [[nodiscard]] bool finished() const override { return steps() >= question_.total_steps(); }
    [[nodiscard]] double progress() const override {
        return static_cast<double>(steps()) / static_cast<double>(question_.total_steps());
    }
    [[nodiscard]] Health health() const override { return {fault_}; }
    [[nodiscard]] double particle_steps() const override {
        return static_cast<double>(steps()) * static_cast<double>(question_.particles);
    }
    void save(Bytes& into) const override {
        into.clear();
        suspension_.save(into);
        append_bytes(into, means_);
        append_bytes(into, budget_);
        record_.save(into);
    }
    void restore(std::span<const std::byte> from) override {
        suspension_.restore(from);
        take_bytes(from, means_);
        take_bytes(from, budget_);
        record_.restore(from);
        require_possible(from.empty() && steps() <= question_.total_steps());
        require_possible(fault(suspension_.fluid(), time()).empty());
        require_possible(fault(suspension_.cloud(), suspension_.fluid().time_step(),
                               1.0 / static_cast<double>(question_.cells), time())
                             .empty());
    }
    [[nodiscard]] Snapshot snapshot() const override {
        Snapshot now = picture(question_, suspension_.cloud());
        const auto& fluid = suspension_.fluid();
        now.fields.push_back(drawn_flow(question_, fluid.velocity(), &fluid.temperature()));
        return now;
    }
    [[nodiscard]] double picture_period() const override { return question_.steady_force() ? 0 : question_.period(); }

private:
    [[nodiscard]] std::int64_t steps() const { return suspension_.fluid().steps(); }

    void step() {
        suspension_.step();
        const auto& fluid = suspension_.fluid();
        const bool sampled = steps() % question_.sample_steps() == 0 || finished();
        std::string thrown =
            fault(suspension_.cloud(), fluid.time_step(), 1.0 / static_cast<double>(question_.cells), time());
        if (sampled || steps() % watch_ == 0 || !thrown.empty()) {  // it may be the fluid that threw the particle
            fault_ = fault(fluid, time());
            if constexpr (requires { suspension_.solids(); })
                if (fault_.empty()) fault_ = fault(suspension_.solids(), fluid.grid(), time());
            if (fault_.empty()) fault_ = std::move(thrown);
            if (!fault_.empty()) return;
        }
        const bool counted = steps() > question_.total_steps() - question_.window();
        if (counted) means_.add(fluid, question_.window());
        if (finished()) record_.set_flow(means_);
        if constexpr (requires { suspension_.budget(); }) {
            if (counted) budget_.add(suspension_.budget(), question_.window());
            if (finished()) record_.set_budget(budget_);
        }
        if constexpr (requires { suspension_.interaction().limited_steps(); })
            record_.set_limited_share(static_cast<double>(suspension_.interaction().limited_steps()) /
                                      static_cast<double>(steps()));
        if (sampled) record_.sample(time(), suspension_.cloud());
    }

    Question question_;
    Record record_;
    FlowMeans means_;  // of the last window, as far as it has come
    BudgetMeans budget_;
    Together suspension_;
    Slabs slabs_;
    std::int64_t watch_ = watch_interval(question_.window());
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

template <class Level, class Kernel>
class Carried final : public Scene {
public:
    Carried(const Question& question, std::uint64_t seed, Artefacts& artefacts)
        : question_(question),
          artefacts_(artefacts),
          grid_(question.flow_grid()),
          walls_(question.walls()),
          motion_(question.sphere(), question.step()),
          cloud_(question.cloud(seed)),
          record_(question),
          flow_(grid_) {
        if (const auto found = artefacts_.get(question_.flow_key()); !found || !received(*found))
            spin_up_.emplace(question_);
        record_.sample(0, cloud_);
    }

    void advance(double until) override {
        while (time() < until && !finished() && fault_.empty()) {
            if (spin_up_)
                settle();
            else
                step();
        }
    }
    int use_threads(int count) override {
        const int wanted = threads_for(grid_, count);
        if (wanted != slabs_.count()) slabs_ = Slabs(wanted);
        if (spin_up_) spin_up_->use(slabs_);
        return wanted;
    }
    void observe(Observations& into) const override { record_.observe(into); }
    /// The time the flow took to become periodic, if it was found here, and the time of the particles since.
    [[nodiscard]] double time() const override {
        return (spin_up_ ? spin_up_->time() : spun_) + static_cast<double>(steps_) * question_.step();
    }
    [[nodiscard]] bool finished() const override { return !spin_up_ && steps_ >= question_.total_steps(); }
    [[nodiscard]] double progress() const override {
        constexpr double usual_spin_up = 0.25;
        if (spin_up_) return 0.5 * std::min(1.0, spin_up_->time() / usual_spin_up);
        const double share = static_cast<double>(steps_) / static_cast<double>(question_.total_steps());
        return spun_ > 0 ? 0.5 + 0.5 * share : share;
    }
    [[nodiscard]] Health health() const override { return {fault_}; }
    [[nodiscard]] double particle_steps() const override {
        return static_cast<double>(steps_) * static_cast<double>(question_.particles);
    }
    void save(Bytes& into) const override {
        into.clear();
        append_bytes(into, static_cast<std::int64_t>(spin_up_.has_value()));
        append_bytes(into, steps_);
        append_bytes(into, spun_);
        append_bytes<coupling::Vec3>(into, cloud_.position);
        append_bytes<coupling::Vec3>(into, cloud_.velocity);
        record_.save(into);
        if (spin_up_)
            spin_up_->save(into);
        else
            flow_.save(into);
    }
    void restore(std::span<const std::byte> from) override {
        std::int64_t spinning = 0;
        take_bytes(from, spinning);
        take_bytes(from, steps_);
        take_bytes(from, spun_);
        take_bytes<coupling::Vec3>(from, cloud_.position);
        take_bytes<coupling::Vec3>(from, cloud_.velocity);
        record_.restore(from);
        if (spinning != 0) {
            spin_up_.emplace(question_);
            spin_up_->restore(from);
        } else {
            spin_up_.reset();
            flow_.restore(from);
        }
        require_possible(from.empty() && steps_ >= 0 && steps_ <= question_.total_steps());
        require_possible(fault(cloud_, question_.step(), 1.0 / static_cast<double>(question_.cells), time()).empty());
    }
    /// Without temperature, which the stored flow has not.
    [[nodiscard]] Snapshot snapshot() const override {
        Snapshot now = picture(question_, cloud_);
        if (spin_up_) {
            now.fields.push_back(drawn_flow(question_, spin_up_->velocity(), nullptr));
        } else {
            auto velocity = flow::face_vectors(grid_);
            const auto in_period = static_cast<double>(steps_ % question_.steps_per_period);
            flow_.velocity(question_.frequency * in_period * question_.step(), velocity);
            now.fields.push_back(drawn_flow(question_, velocity, nullptr));
        }
        return now;
    }
    [[nodiscard]] double picture_period() const override { return question_.period(); }

private:
    void settle() {
        spin_up_->step();
        fault_ = spin_up_->fault();
        if (!spin_up_->periodic()) return;
        Bytes contents;
        append_bytes(contents, spin_up_->means());
        spin_up_->stored().save(contents);
        artefacts_.put(question_.flow_key(), contents);
        spun_ = spin_up_->time();
        spin_up_.reset();
        receive(contents);
    }

    /// False for bytes that are no such flow: it is found anew.
    [[nodiscard]] bool received(std::span<const std::byte> contents) {
        try {
            receive(contents);
            return true;
        } catch (const std::invalid_argument&) {
            return false;
        }
    }

    void receive(std::span<const std::byte> contents) {
        FlowMeans means;
        take_bytes(contents, means);
        flow_.restore(contents);
        require_possible(contents.empty());
        record_.set_flow(means);
    }

    void step() {
        const double dt = question_.step();
        const auto in_period = static_cast<double>(steps_ % question_.steps_per_period) + 0.5;
        const double phase = question_.frequency * in_period * dt;
        const double c = std::cos(phase);
        const double s = std::sin(phase);
        const std::array<double, coupling::PeriodicFlow::terms> basis{1, c, s, c * c - s * s, 2 * s * c};
        const double vibration = question_.vibration().at(in_period * dt);
        const auto middle = [&](std::size_t p) {
            coupling::Vec3 x = cloud_.position[p];
            for (std::size_t d = 0; d < 3; ++d) x[d] += 0.5 * dt * cloud_.velocity[p][d];
            return walls_.clipped(x);
        };
        using Stencil = coupling::Stencil<Kernel>;
        coupling::march(
            cloud_, motion_, walls_, vibration, order_.of(cloud_, grid_),
            [&](std::size_t p) {
                if constexpr (Level::mirrored)
                    return Stencil(grid_, walls_.periodic, Level::below(middle(p)));
                else
                    return Stencil(grid_, walls_.periodic, middle(p));
            },
            [&](std::size_t p, const Stencil& stencil) {
                coupling::Surroundings around = flow_.at(stencil, basis);
                if constexpr (Level::mirrored) Level::turn(middle(p), around);
                return around;
            },
            [](std::size_t, const coupling::Vec3&) {}, slabs_);
        ++steps_;
        const double now = static_cast<double>(steps_) * dt;
        fault_ = fault(cloud_, dt, 1.0 / static_cast<double>(question_.cells), now);
        if (!fault_.empty()) return;
        if (steps_ % question_.sample_steps() == 0 || finished()) record_.sample(now, cloud_);
    }

    Question question_;
    Artefacts& artefacts_;
    flow::Grid grid_;
    coupling::Walls walls_;
    coupling::Motion<Drag> motion_;
    coupling::Cloud cloud_;
    coupling::VisitOrder order_;
    Record record_;
    coupling::PeriodicFlow flow_;
    Slabs slabs_;
    std::optional<SpinUp> spin_up_;  // only while the flow is not yet known
    std::int64_t steps_ = 0;         // of the particles
    double spun_ = 0;
    std::string fault_;
};

}  // namespace grainsweep::thermovibration
