#include "solver/scenes/hopper/experiment.hpp"

#include "solver/observables/beverloo.hpp"
#include "solver/scenes/dem_picture.hpp"
#include "solver/scenes/hopper/record.hpp"
#include "solver/scenes/kit/checkpoint.hpp"
#include "solver/scenes/kit/filling.hpp"
#include "solver/scenes/kit/slices.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace grainsweep::hopper {
namespace {

constexpr std::uint64_t checkpoint_format = 0x6772'6e73'686f'0001ULL;  // "grnsho", version 1
constexpr double rate_from = 0.1, rate_to = 0.5;                       // of the mass
constexpr double dome = 0.2;                                           // solid fraction over a jammed opening

}  // namespace

Experiment::Experiment(const Study& study, std::uint64_t seed, const dem::Method& method) : study_(study) {
    const dem::Setup setup = closed(study_, seed);
    domain_ = setup.domain;
    for (const auto& sphere : setup.spheres) {
        radius_.push_back(sphere.radius);
        mass_ += dem::sphere_mass(sphere.radius, study_.material.density);
        mean_diameter_ += 2 * sphere.radius / static_cast<double>(setup.spheres.size());
    }
    engine_ = dem::make_engine(setup, method);
    if (study_.settle_steps == 0) open();
}

void Experiment::advance(double until) {
    while (!finished() && health().stable() && time() < until) {
        const std::int64_t stop =
            is_open() ? study_.step_of_frame(static_cast<std::int64_t>(outflow_.size())) : study_.settle_steps;
        step_ = kit::run_towards(*engine_, step_, stop, study_.time_step, until);
        if (!health().stable() || step_ < stop) continue;
        if (is_open())
            take_frame();
        else
            open();
    }
}

void Experiment::open() {
    engine_->state(state_);
    bulk_fraction_ = observables::settled_fraction(state_, study_.cone_height(), study_.diameter, study_.section());
    engine_->forget_peak_overlap();
    engine_->set_walls(open_walls(study_));
    take_frame();
}

void Experiment::take_frame() {
    engine_->state(state_);
    const auto frame = static_cast<std::int64_t>(outflow_.size());
    outflow_.push_back(observables::outflow(state_, radius_, study_.material.density, study_.time_of_frame(frame)));
    const double half = std::max(study_.opening / 2, study_.diameter), height = 2 * half;
    const double space = (study_.slot ? 2 * half * study_.slot_length : std::numbers::pi * half * half) * height;
    over_opening_ = observables::solid_over_opening(state_, half, height, study_.slot) / space;
    const double out = outflow_.back().mass;
    const bool enough =
        study_.stop_share < 1 ? out >= study_.stop_share * mass_ : outflow_.back().count == std::ssize(radius_);
    ended_ = enough || ceased() || frame + 1 == study_.frames;
}

bool Experiment::ceased() const {
    const auto& now = outflow_.back();
    if (now.time < study_.quiet_time()) return false;
    const auto since =
        std::ranges::find_if(outflow_, [&](const auto& frame) { return frame.time > now.time - study_.quiet_time(); });
    return since->count == now.count;
}

double Experiment::progress() const {
    if (ended_) return 1;
    const auto all = static_cast<double>(study_.step_of_frame(study_.frames - 1));
    const double out = is_open() ? outflow_.back().mass / (study_.stop_share * mass_) : 0;
    return std::clamp(std::max(static_cast<double>(step_) / std::max(all, 1.0), out), 0.0, 1.0);
}

void Experiment::observe(Observations& into) const {
    record::particles.record(into, static_cast<double>(radius_.size()));
    kit::record_bond_number(into, study_.material, study_.diameter, study_.gravity);
    if (!is_open()) return;
    record::max_overlap.record(into, engine_->peak_overlap());
    record::bulk_fraction.record_known(into, bulk_fraction_);
    observe_rate(into);
    auto& series = record::mass_series.in(into);
    for (const auto& frame : outflow_) series.push_back({.time = frame.time, .value = frame.mass});
    record::discharged.record(into, outflow_.back().mass / mass_);
    record::flow_time.record(into, outflow_.back().time);
    if (finished()) record::jammed.record(into, ceased() && over_opening_ > dome ? 1 : 0);
}

void Experiment::observe_rate(Observations& into) const {
    const double d = study_.diameter, density = study_.material.density;
    if (!study_.slot && std::isfinite(bulk_fraction_))
        record::beverloo_rate.record(into,
                                     observables::beverloo_rate(study_.opening, d, bulk_fraction_, study_.gravity) *
                                         particles::sphere_volume(d) * density);
    const auto found = observables::rate_between(outflow_, mass_, rate_from, rate_to);
    if (!std::isfinite(found.rate)) return;
    record::rate.record(into, found.rate);
    record::rate_error.record_known(into, found.standard_error);
    const double power = study_.slot ? d * std::sqrt(d) * study_.slot_length : d * d * std::sqrt(d);
    record::rate_scaled.record(into, found.rate / (density * std::sqrt(study_.gravity) * power));
    if (!study_.sizes.equal() && std::isfinite(found.mean_diameter))
        record::segregation.record(into, found.mean_diameter / mean_diameter_ - 1);
}

Snapshot Experiment::snapshot() const {
    Snapshot picture = picture_of(*engine_);
    if (study_.slot) picture.periods[1] = study_.slot_length;
    dem::Vec3 low{-study_.half_width, -study_.half_width, domain_.low[2]};
    dem::Vec3 high{study_.half_width, study_.half_width, domain_.high[2]};
    if (study_.slot) low[1] = 0, high[1] = study_.slot_length;
    const auto walls = open_walls(study_);
    for (std::size_t w = 0; w < walls.size(); ++w)
        picture.walls.push_back(surface_of(walls[w], "wall_" + std::to_string(w), low, high, 0));
    return picture;
}

void Experiment::save(Bytes& into) const {
    kit::write_checkpoint(into, checkpoint_format, *engine_, [this](ByteWriter& out) {
        out.put(step_);
        out.put(ended_);
        out.put(bulk_fraction_);
        out.put(over_opening_);
        out.put(outflow_);
    });
}

void Experiment::restore(std::span<const std::byte> from) {
    ByteReader in = kit::open_checkpoint(from, checkpoint_format);
    in.get(step_);
    in.get(ended_);
    in.get(bulk_fraction_);
    in.get(over_opening_);
    in.get(outflow_);
    const Bytes engine = kit::engine_at_end(in);
    const auto frames = std::ssize(outflow_);
    in.require(step_ >= 0 && frames <= study_.frames && (!ended_ || frames > 0));
    in.require(step_ <= (frames > 0 ? study_.step_of_frame(frames) : study_.settle_steps));
    in.require(frames == 0 || step_ >= study_.step_of_frame(frames - 1));
    in.require(ended_ || frames < study_.frames);
    for (const auto& frame : outflow_)
        in.require(std::isfinite(frame.time) && std::isfinite(frame.mass) && frame.count >= 0 &&
                   frame.count <= std::ssize(radius_));
    engine_->restore(engine);
}

}  // namespace grainsweep::hopper
