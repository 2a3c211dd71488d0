#include "solver/scenes/heap/experiment.hpp"

#include "solver/scenes/dem_picture.hpp"
#include "solver/scenes/heap/record.hpp"
#include "solver/scenes/kit/checkpoint.hpp"
#include "solver/scenes/kit/slices.hpp"

#include <algorithm>
#include <cmath>

namespace grainsweep::heap {
namespace {

constexpr std::uint64_t checkpoint_format = 0x6772'6e73'6870'0001ULL;  // "grnshp", version 1

}  // namespace

Experiment::Experiment(const Study& study, std::uint64_t seed, const dem::Method& method) : study_(study) {
    const dem::Setup setup = filled(study_, seed);
    domain_ = setup.domain;
    walls_ = setup.walls;
    glued_ = std::ranges::count(setup.spheres, false, &dem::Sphere::mobile);
    engine_ = dem::make_engine(setup, method);
}

void Experiment::advance(double until) {
    while (!finished() && health().stable() && time() < until) {
        const std::int64_t stop =
            std::min((step_ / study_.steps_per_look + 1) * study_.steps_per_look, study_.last_step);
        step_ = kit::run_towards(*engine_, step_, stop, study_.time_step, until);
        if (health().stable() && step_ == stop) look();
    }
}

void Experiment::look() {
    engine_->state(state_);
    double top = 0;
    for (std::size_t i = 0; i < state_.id.size(); ++i)
        if (state_.mobile[i] != 0) top = std::max(top, state_.position[i][2] + state_.radius[i]);
    const bool clear = study_.lower_end(time()) > top;
    ended_ = step_ == study_.last_step || (clear && observables::rms_speed(state_) < study_.rest_speed());
}

void Experiment::observe(Observations& into) const {
    record::particles.record(into, static_cast<double>(engine_->size()) - static_cast<double>(glued_));
    record::max_overlap.record(into, engine_->peak_overlap());
    kit::record_bond_number(into, study_.material, study_.diameter, study_.gravity);
    if (!finished()) return;
    dem::State state;
    engine_->state(state);
    const auto shape = observables::heap_shape(state, study_.diameter, study_.reach());
    record::angle.record_known(into, shape.angle);
    record::angle_residual.record_known(into, shape.residual / study_.diameter);
    record::angle_moment.record_known(into, shape.angle_moment);
    record::height.record_known(into, shape.height);
    record::run_out.record_known(into, shape.run_out);
    const double speed = observables::rms_speed(state);
    record::rms_speed.record(into, speed);
    record::at_rest.record(into, speed < study_.rest_speed() ? 1 : 0);
    auto& outline = record::outline.in(into);
    for (std::size_t k = 0; k < shape.outline.size(); ++k)
        outline.push_back({.bin = (static_cast<double>(k) + 0.5) * study_.diameter, .value = shape.outline[k]});
}

Snapshot Experiment::snapshot() const {
    Snapshot picture = picture_of(*engine_);
    picture.walls.push_back(surface_of(walls_[0], "plate", domain_.low, domain_.high, engine_->wall_time()));
    picture.walls.push_back(surface_of(walls_[1], "tube", domain_.low, domain_.high, engine_->wall_time()));
    return picture;
}

void Experiment::save(Bytes& into) const {
    kit::write_checkpoint(into, checkpoint_format, *engine_, [this](ByteWriter& out) {
        out.put(step_);
        out.put(ended_);
    });
}

void Experiment::restore(std::span<const std::byte> from) {
    ByteReader in = kit::open_checkpoint(from, checkpoint_format);
    in.get(step_);
    in.get(ended_);
    const Bytes engine = kit::engine_at_end(in);
    in.require(step_ >= 0 && step_ <= study_.last_step && (ended_ || step_ < study_.last_step));
    engine_->restore(engine);
}

}  // namespace grainsweep::heap
