#include "solver/scenes/thermovibration/levels.hpp"

#include "solver/coupling/dense_suspension.hpp"
#include "solver/coupling/projected_contacts.hpp"
#include "solver/coupling/self_disturbance.hpp"
#include "solver/coupling/solids_pressure.hpp"
#include "solver/coupling/spring_contacts.hpp"
#include "solver/coupling/suspension.hpp"
#include "solver/scenes/thermovibration/question.hpp"
#include "solver/scenes/thermovibration/runs.hpp"

#include <algorithm>
#include <utility>

namespace grainsweep::thermovibration {
namespace {

template <class Together>
class CoupledAs final : public Coupled {
public:
    template <class... Arguments>
    explicit CoupledAs(Arguments&&... arguments) : together_(std::forward<Arguments>(arguments)...) {}

    void use(const Slabs& slabs) override { together_.use(slabs); }
    void step() override { together_.step(); }
    [[nodiscard]] const flow::Flow<flow::Boussinesq>& fluid() const override { return together_.fluid(); }
    [[nodiscard]] const coupling::Cloud& cloud() const override { return together_.cloud(); }
    [[nodiscard]] const coupling::SolidsVolume* solids() const override {
        if constexpr (requires { together_.solids(); }) return &together_.solids();
        return nullptr;
    }
    [[nodiscard]] const coupling::MomentumBudget* budget() const override {
        if constexpr (requires { together_.budget(); }) return &together_.budget();
        return nullptr;
    }
    [[nodiscard]] std::optional<std::int64_t> limited_steps() const override {
        if constexpr (requires { together_.interaction().limited_steps(); })
            return together_.interaction().limited_steps();
        return std::nullopt;
    }
    void save(std::vector<std::byte>& into) const override { together_.save(into); }
    void restore(std::span<const std::byte>& from) override { together_.restore(from); }

private:
    Together together_;
};

coupling::Motion<Drag> motion_of(const Question& q) {
    return {q.sphere(), q.step()};
}

template <class Level>
std::unique_ptr<Coupled> dilute(const Question& q, std::uint64_t seed, Level level) {
    return std::make_unique<CoupledAs<coupling::Suspension<flow::Boussinesq, Level, coupling::Trilinear, Drag>>>(
        q.fluid(), q.vibration(), motion_of(q), q.walls(), q.cloud(seed), std::move(level));
}

template <class Interaction>
std::unique_ptr<Coupled> dense(const Question& q, std::uint64_t seed, Interaction interaction) {
    return std::make_unique<
        CoupledAs<coupling::DenseSuspension<flow::Boussinesq, Interaction, coupling::Trilinear, Drag>>>(
        q.fluid(), q.vibration(), motion_of(q), q.walls(), q.cloud(seed), std::move(interaction), q.kernel());
}

std::unique_ptr<Coupled> one_way(const Question& q, std::uint64_t seed) {
    return q.mirrored() ? dilute(q, seed, coupling::OneWayMirrored{}) : dilute(q, seed, coupling::OneWay{});
}

std::unique_ptr<Coupled> two_way(const Question& q, std::uint64_t seed) {
    const auto particles = static_cast<std::size_t>(q.particles);
    if (q.own_wake == "kept")
        return dilute(q, seed, coupling::TwoWay(q.grid(), Question::sides(), q.sphere(), particles, q.kernel()));
    return dilute(
        q, seed,
        coupling::TwoWayWithoutOwnWake(q.grid(), Question::sides(), q.sphere(), particles, q.kernel(), q.step()));
}

template <class Temperature>
std::unique_ptr<Coupled> granular(const Question& q, std::uint64_t seed) {
    return dense(q, seed,
                 coupling::SolidsPressure<Temperature>(q.grid(), Question::sides(), q.sphere(), q.grains(),
                                                       q.granular_temperature, q.kernel()));
}

std::unique_ptr<Coupled> with_contacts(const Question& q, std::uint64_t seed) {
    return q.contact == "spring" ? dense(q, seed,
                                         coupling::SpringContacts(q.sphere(), q.walls(), q.spring(),
                                                                  static_cast<std::size_t>(q.particles)))
                                 : dense(q, seed, coupling::ProjectedContacts(q.sphere(), q.walls()));
}

constexpr LevelInfo all_levels[] = {
    {.name = "one_way", .make = one_way},
    {.name = "two_way", .acts_on_fluid = true, .make = two_way},
    {.name = "ddpm",
     .acts_on_fluid = true,
     .dense = true,
     .stressed = true,
     .seconds_on_grid = 7e-3,
     .make = granular<coupling::AlgebraicTemperature>},
    {.name = "ddpm_ktgf",
     .acts_on_fluid = true,
     .dense = true,
     .stressed = true,
     .seconds_on_grid = 7e-3,
     .make = granular<coupling::TransportedTemperature>},
    {.name = "cfd_dem",
     .acts_on_fluid = true,
     .dense = true,
     .resolves_contacts = true,
     .seconds_on_grid = 4e-3,
     .make = with_contacts},
};

}  // namespace

std::span<const LevelInfo> levels() {
    return all_levels;
}

const LevelInfo& level_named(std::string_view name) {
    return *std::ranges::find(all_levels, name, &LevelInfo::name);
}

CarriedStep* carried_step(const Question& q) {
    using coupling::Trilinear;
    return q.mirrored() ? carry<coupling::OneWayMirrored, Trilinear> : carry<coupling::OneWay, Trilinear>;
}

}  // namespace grainsweep::thermovibration
