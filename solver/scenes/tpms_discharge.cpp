// Powder leaving a TPMS cell under gravity (Gupta, Ness & Haeri, gravity-driven evacuation of metal powder
// through triply periodic minimal surfaces).
//
// A random close packing fills the cube [0, L]^3; spheres with |f| <= C are frozen as the cell's wall, those of
// the kept side start at rest, the rest is deleted (geometry/tpms.hpp). At t = 0 gravity acts. All six faces are
// open; a sphere whose centre is more than two diameters outside the cell is gone. The answer is the retention:
// mobile centres in the cell over those at the start. Times are in t* = sqrt(2 L/g), speeds in sqrt(2 g L).
// All positions and speeds are in the frame of the cell, also if it vibrates; in this frame the powder starts at rest.
//
// Unnecessary work is avoided. Frozen spheres that no mobile one can touch, while overlaps stay below a tenth of a
// diameter, are removed (particles/reach.hpp); a larger overlap at any step is reported as unstable. A case ends when
// no mobile sphere is left and, with the rule "quiet", when the powder has come to rest. Rest means that for 1.5 t* at
// most one sphere in a thousand of the rest (or one) moved at a time, and the count changed by no more. Those few may
// still leave; beyond them the rule presumes that what rests stays at rest.
#include "solver/geometry/level_surface.hpp"
#include "solver/geometry/tpms_outlet.hpp"
#include "solver/geometry/vector.hpp"
#include "solver/observables/beverloo.hpp"
#include "solver/particles/tpms_filling.hpp"
#include "solver/scenes/catalogue.hpp"
#include "solver/scenes/dem_picture.hpp"
#include "solver/scenes/drawn_box.hpp"
#include "solver/scenes/kit/checkpoint.hpp"
#include "solver/scenes/kit/pace.hpp"
#include "solver/scenes/tpms/observables.hpp"
#include "solver/scenes/tpms/question.hpp"
#include "solver/scenes/tpms/record.hpp"
#include "solver/scenes/tpms/warnings.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>

namespace grainsweep {
namespace {

using geometry::Vec3;

constexpr double margin = 2;            // diameters around the cell before a sphere is gone
constexpr double most_overlap = 0.1;    // diameters; removing wall spheres is correct below this
constexpr double sample_time = 0.0165;  // t*, between two samples
constexpr std::int64_t samples_per_force_sample = 10;
constexpr double quiet_speed = 1e-3;  // sqrt(2 g L)
constexpr std::size_t layers = 20;

particles::Packing packing_of(const TpmsQuestion& question, const Inputs& inputs, Artefacts& artefacts,
                              const Files& files) {
    if (question.packing_given) return particles::read_packing(tpms_packing_text(inputs, files), question.edge);
    const particles::PackingRequest request{
        .edge = question.edge, .fraction = question.packing_fraction, .seed = question.packing_seed};
    const std::string key = particles::packing_key(request);
    if (const auto kept = artefacts.get(key)) {
        try {
            particles::Packing packing = particles::decode_packing(*kept);
            if (packing.edge == question.edge && !packing.positions.empty()) return packing;
        } catch (const std::invalid_argument&) {  // packed anew below
        }
    }
    particles::Packing packing = particles::random_close_packing(request);
    artefacts.put(key, particles::encode(packing));
    return packing;
}

class TpmsDischarge final : public Scene {
public:
    /// Outlet in diameters; fraction: of the packing that the cell was cut from.
    TpmsDischarge(const TpmsQuestion& question, const particles::TpmsFilling& filling, double outlet, double fraction);

    void advance(double until) override;
    int use_threads(int count) override { return engine_->set_threads(count); }
    void observe(Observations& into) const override;
    [[nodiscard]] double time() const override { return static_cast<double>(step_) * question_.time_step; }
    [[nodiscard]] bool finished() const override;
    [[nodiscard]] bool may_end_early() const override { return true; }
    [[nodiscard]] double progress() const override {
        return finished() ? 1 : static_cast<double>(step_) / static_cast<double>(last_step_);
    }
    [[nodiscard]] Health health() const override { return {fault_}; }
    [[nodiscard]] double particle_steps() const override { return engine_->work().particle_steps; }
    [[nodiscard]] std::map<std::string, double, std::less<>> phase_seconds() const override {
        return engine_->work().seconds;
    }
    void save(Bytes& into) const override;
    void restore(std::span<const std::byte> from) override;
    [[nodiscard]] Snapshot snapshot() const override;

private:
    [[nodiscard]] WallSurface cell_surface() const;
    [[nodiscard]] bool in_cell(const Vec3& x) const;
    [[nodiscard]] std::size_t layer(const Vec3& x) const;
    void sample();
    /// Share of the powder per t* that Beverloo's law lets through the outlet.
    [[nodiscard]] double beverloo() const;
    void observe_profile(Observations& into) const;

    TpmsQuestion question_;
    double outlet_ = 0, fraction_ = 0;
    std::size_t wall_spheres_ = 0;
    std::int64_t start_count_ = 0;
    std::array<std::int64_t, layers> start_layers_{};
    std::int64_t sample_interval_ = 1, last_step_ = 1;
    std::unique_ptr<dem::Engine> engine_;
    dem::State state_;  // of the last sample
    std::vector<dem::ContactForce> contacts_;

    std::int64_t step_ = 0;
    std::int64_t mobile_left_ = 0;
    double max_overlap_ = 0;  // diameters
    TpmsRecord record_;
    std::string fault_;
    mutable std::optional<WallSurface> drawn_cell_;  // made for the first picture
};

TpmsDischarge::TpmsDischarge(const TpmsQuestion& question, const particles::TpmsFilling& filling, double outlet,
                             double fraction)
    : question_(question),
      outlet_(outlet),
      fraction_(fraction),
      wall_spheres_(filling.wall_spheres),
      start_count_(static_cast<std::int64_t>(filling.mobile.size())),
      record_(question_, start_count_) {
    const double d = question.diameter;
    dem::Setup setup;
    for (std::size_t k = 0; k < 3; ++k) {
        setup.domain.low[k] = -margin * d;
        setup.domain.high[k] = question.length() + margin * d;
        setup.gravity[k] = question.gravity * question.down[k];
    }
    setup.shaking = question.shaking;
    setup.material = question.material;
    setup.frozen = question.wall;
    setup.time_step = question.time_step;
    const auto add = [&](const Vec3& x, bool mobile) {
        setup.spheres.push_back({{x[0] * d, x[1] * d, x[2] * d}, {}, {}, d / 2, mobile});
    };
    for (const auto& x : filling.mobile) add(x, true);
    for (const auto& x : filling.wall) add(x, false);
    mobile_left_ = start_count_;
    for (const auto& sphere : setup.spheres)
        if (sphere.mobile) ++start_layers_[layer(sphere.position)];

    const double steps_per_t_star = question.free_fall_time() / question.time_step;
    sample_interval_ = std::max<std::int64_t>(1, std::llround(std::floor(sample_time * steps_per_t_star)));
    last_step_ = std::max<std::int64_t>(1, std::llround(std::ceil(question.end_time * steps_per_t_star)));
    dem::Method method;
    method.precision = question.precision;
    method.rest_speed = question.rest_speed * question.free_fall_speed();
    engine_ = dem::make_engine(setup, method);
    sample();
}

bool TpmsDischarge::in_cell(const Vec3& x) const {
    return std::ranges::all_of(x, [edge = question_.length()](double c) { return c >= 0 && c <= edge; });
}

std::size_t TpmsDischarge::layer(const Vec3& x) const {
    const double place = x[2] / question_.length() * static_cast<double>(layers);
    return static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(layers - 1)));
}

void TpmsDischarge::advance(double until) {
    while (time() < until && !finished() && fault_.empty()) {
        const std::int64_t next_sample = (step_ / sample_interval_ + 1) * sample_interval_;
        const auto asked = static_cast<std::int64_t>(std::min(std::ceil(until / question_.time_step), 9e18));
        const std::int64_t target = std::min({next_sample, last_step_, std::max(asked, step_ + 1)});
        const std::int64_t before = engine_->work().steps;
        engine_->run(target - step_);
        step_ += engine_->work().steps - before;
        fault_ = engine_->fault();
        if (step_ == next_sample || step_ == last_step_) sample();
    }
}

void TpmsDischarge::sample() {
    engine_->state(state_);
    Moment now{};
    now.step = step_;
    const double slow = quiet_speed * question_.free_fall_speed();
    mobile_left_ = 0;
    for (std::size_t i = 0; i < state_.id.size(); ++i) {
        if (state_.mobile[i] == 0) continue;
        ++mobile_left_;
        if (!in_cell(state_.position[i])) continue;
        ++now.in_cell;
        now.fastest_down = std::max(now.fastest_down, geometry::dot(state_.velocity[i], question_.down));
        const double speed = geometry::norm(state_.velocity[i]);
        now.at_rest += speed < slow ? 1 : 0;
    }
    now.mobile = mobile_left_;
    if (now.in_cell == 0) now.fastest_down = std::numeric_limits<double>::quiet_NaN();
    record_.add(now);
    engine_->contacts(contacts_);
    record_.add(contacts_, step_, (step_ / sample_interval_) % samples_per_force_sample == 0 || step_ == last_step_);

    max_overlap_ = engine_->peak_overlap();
    if (fault_.empty() && max_overlap_ > most_overlap) {
        char sentence[160];
        std::snprintf(
            sentence, sizeof sentence,
            "two particles overlapped by %.3g of a diameter before %.4g s: more than the %.3g up to which the "
            "wall is known to be tight",
            max_overlap_, time(), most_overlap);
        fault_ = sentence;
    }
}

bool TpmsDischarge::finished() const {
    if (step_ >= last_step_ || mobile_left_ == 0) return true;
    // As of the last sample: where slices of time end between samples must not decide when the case ends.
    return question_.stop_when_quiet && record_.is_quiet(step_ / sample_interval_ * sample_interval_);
}

double TpmsDischarge::beverloo() const {
    if (question_.down != std::array<double, 3>{0, 0, -1}) return std::numeric_limits<double>::quiet_NaN();
    const double d = question_.diameter;
    return observables::beverloo_rate(outlet_ * d, d, fraction_, question_.gravity) * question_.free_fall_time() /
           static_cast<double>(start_count_);
}

void TpmsDischarge::observe_profile(Observations& into) const {
    dem::State state;
    engine_->state(state);
    std::array<std::int64_t, layers> now{};
    for (std::size_t i = 0; i < state.id.size(); ++i)
        if (state.mobile[i] != 0 && in_cell(state.position[i])) ++now[layer(state.position[i])];
    auto& profile = tpms_record::retained_profile.in(into);
    for (std::size_t k = 0; k < layers; ++k) {
        if (start_layers_[k] == 0) continue;
        const double centre = (static_cast<double>(k) + 0.5) / static_cast<double>(layers);
        const double share = static_cast<double>(now[k]) / static_cast<double>(start_layers_[k]);
        profile.push_back({.bin = centre, .value = share});
    }
}

void TpmsDischarge::observe(Observations& into) const {
    record_.observe(into);
    observe_profile(into);
    kit::record_bond_number(into, question_.material, question_.diameter, question_.gravity);
    tpms_record::beverloo_rate.record(into, beverloo());
    tpms_record::outlet_diameter.record(into, outlet_);
    tpms_record::max_overlap.record(into, max_overlap_);
    tpms_record::particles.record(into, static_cast<double>(start_count_));
    tpms_record::wall_particles.record(into, static_cast<double>(wall_spheres_));
}

void TpmsDischarge::save(Bytes& into) const {
    ByteWriter out(into);
    out.put(step_);
    out.put(mobile_left_);
    out.put(max_overlap_);
    out.put(fault_);
    record_.save(out);
    std::vector<std::byte> engine;
    engine_->save(engine);
    out.put(engine);
}

void TpmsDischarge::restore(std::span<const std::byte> from) {
    ByteReader in(from);
    in.get(step_);
    in.get(mobile_left_);
    in.get(max_overlap_);
    in.get(fault_);
    record_.restore(in);
    const Bytes engine = kit::engine_at_end(in);
    in.require(step_ >= 0 && step_ <= last_step_ && mobile_left_ >= 0 && mobile_left_ <= start_count_);
    engine_->restore(engine);
    engine_->state(state_);
}

/// The middle surface of the shell, f = 0, and the edges of the cell.
WallSurface TpmsDischarge::cell_surface() const {
    constexpr int grid = 36;
    const double length = question_.length();
    const geometry::TpmsShell shell(question_.cell, question_.side, length, question_.shell * question_.diameter);
    auto surface =
        geometry::level_surface([&shell](const Vec3& x) { return shell.value(x); }, {}, {length, length, length}, grid);
    WallSurface cell{"cell", std::move(surface.corners), std::move(surface.triangles), {}};
    add_box({}, {length, length, length}, cell);
    return cell;
}

/// In the frame of the cell; wall spheres that nothing can touch are not there.
Snapshot TpmsDischarge::snapshot() const {
    if (!drawn_cell_) drawn_cell_ = cell_surface();
    Snapshot picture = picture_of(*engine_);
    picture.walls.push_back(*drawn_cell_);
    return picture;
}

/// Share of the cell's volume where mobile spheres can be, from a grid of points.
double kept_share(const TpmsQuestion& question) {
    constexpr int grid = 20;
    const geometry::TpmsShell shell(question.cell, question.side, question.edge, question.shell);
    const auto place = [&](int k) { return question.edge * (k + 0.5) / grid; };
    int kept = 0;
    for (int k = 0; k < grid * grid * grid; ++k)
        kept += shell.classify({place(k % grid), place(k / grid % grid), place(k / grid / grid)}) ==
                        geometry::TpmsRegion::kept
                    ? 1
                    : 0;
    return kept / std::pow(grid, 3);
}

/// Particle steps of the mobile spheres on average in the box, and the packing.
CostEstimate cost_of_cell(const Inputs& inputs, const Files& files) {
    const TpmsQuestion question(inputs, 1);
    const double cell = std::pow(question.edge, 3);
    const double spheres = question.packing_given
                               ? static_cast<double>(std::ranges::count(tpms_packing_text(inputs, files), '\n')) - 1
                               : question.packing_fraction * 6 / std::numbers::pi * cell;
    const double steps = question.end_time * question.free_fall_time() / question.time_step;
    const double cohesive =
        std::min(1.0, question.material.cohesion / 35e3 + (question.material.surface_energy > 0 ? 1 : 0));
    constexpr double emptying = 2.4;  // sqrt(2 L/g), in which a cell without cohesion empties by a factor of e
    const double left = emptying / question.end_time * (1 - std::exp(-question.end_time / emptying));
    const double mobile = kept_share(question) * spheres * std::min(0.95, left + 0.5 * cohesive);
    dem::Method method;
    method.precision = question.precision;
    auto estimate = kit::estimate(method, question.material, mobile, steps);
    const bool mixed = question.precision == dem::Method::Precision::mixed;
    estimate.seconds = estimate.particle_steps * (mixed ? 27e-9 : 150e-9) + 4e-5 * spheres;
    estimate.bytes = kit::estimate(method, question.material, spheres, 0).bytes;
    return estimate;
}

}  // namespace

SceneInfo tpms_discharge_scene() {
    SceneInfo info;
    info.name = "tpms_discharge";
    info.summary = "powder leaving a cell walled by a triply periodic minimal surface under gravity";
    info.revision = 6;
    info.parameters = tpms_discharge_parameters();
    info.observables = tpms_record::observables();
    info.main = {{"retention", "share that stays in the cell"},
                 {"time_to_half", "time until half has left"},
                 {"discharge_rate", "share that leaves per time"},
                 {"max_force", "largest force, in weights"},
                 {"max_overlap", "deepest overlap, in diameters"}};
    // Twice the study's step has 0.6 of the cost. It changes the retention at 1 t* by -0.1 +- 0.07 %, and the retention
    // of a jammed cell at 3 t* by -0.5 +- 1.4 %. But such a cell comes to rest later, and with a step of 3 us never
    // (solver/dem/README.md).
    info.accuracy["fast"] = {{"precision", std::string("mixed")}, {"time_step", 2e-6}};
    info.accuracy["balanced"] = {{"precision", std::string("mixed")}};
    info.accuracy["reference"] = {{"precision", std::string("double")}};
    info.stiffness = "youngs_modulus";
    info.maker = [](const Inputs& inputs, std::uint64_t seed, Artefacts& artefacts,
                    const Files& files) -> std::unique_ptr<Scene> {
        const TpmsQuestion question(inputs, seed);
        const geometry::TpmsShell shell(question.cell, question.side, question.edge, question.shell);
        const particles::Packing packing = packing_of(question, inputs, artefacts, files);
        const auto filling = particles::fill_tpms(packing, shell, 1 - most_overlap);
        if (filling.mobile.empty())
            throw std::invalid_argument(
                "the shell leaves no space for a mobile particle: make it thinner or the edge longer");
        // A wall particle stands half a diameter out of the shell on either side.
        const double outlet = std::max(0.0, geometry::outlet_diameter(shell) - 1);
        const double fraction =
            std::numbers::pi / 6 * static_cast<double>(packing.positions.size()) / std::pow(question.edge, 3);
        return std::make_unique<TpmsDischarge>(question, filling, outlet, fraction);
    };
    info.estimate_cost = cost_of_cell;
    info.warnings = tpms_discharge_warnings;
    return info;
}

}  // namespace grainsweep
