#include "solver/scenes/drum/experiment.hpp"

#include "solver/observables/layer.hpp"
#include "solver/scenes/dem_picture.hpp"
#include "solver/scenes/drum/record.hpp"
#include "solver/scenes/kit/checkpoint.hpp"
#include "solver/scenes/kit/slices.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace grainsweep::drum {
namespace {

constexpr std::uint64_t checkpoint_format = 0x6772'6e73'6472'0001ULL;  // "grnsdr", version 1
constexpr std::size_t blocks = 10;                                     // of the frames
constexpr double hidden = 0.5;                                         // occupancy at the surface
constexpr double middle_half = 0.5, middle_fifth = 0.2;                // of the radius
constexpr double finest = 1.0 / 500;                                   // cell of the sums over the radius
constexpr double degree = std::numbers::pi / 180;

constexpr std::array names = {"drum", "front_plate", "rear_plate"};

double angle_of(const observables::Line& line) {
    return std::atan(0 - line.slope) / degree;
}

}  // namespace

Experiment::Experiment(const Study& study, std::uint64_t seed, const dem::Method& method)
    : study_(study),
      solid_(study.radius, study.length, std::max(study.diameter, finest * study.radius)),
      flow_(study.radius, std::max(study.diameter, 5 * finest * study.radius)),
      cover_(study.radius, study.occupancy_cell) {
    const dem::Setup setup = filled(study_, seed);
    domain_ = setup.domain;
    walls_ = setup.walls;
    engine_ = dem::make_engine(setup, method);
    if (study_.step_of_frame(0) == 0) take_frame();
}

void Experiment::advance(double until) {
    while (!finished() && health().stable() && time() < until) {
        const std::int64_t stop = study_.step_of_frame(frames_taken());
        step_ = kit::run_towards(*engine_, step_, stop, study_.time_step, until);
        if (health().stable() && step_ == stop) take_frame();
    }
}

double Experiment::work_done() const {
    double work = 0;
    for (std::size_t w = 0; w < walls_.size(); ++w) work += engine_->wall_load(w, {}).work;
    return work;
}

void Experiment::take_frame() {
    if (angle_.empty()) {
        engine_->forget_peak_overlap();
        first_work_ = work_done();
    }
    engine_->state(state_);
    engine_->contacts(contacts_);
    angle_.push_back(observables::lean(state_));
    const auto section = observables::section_of(state_);
    solid_.add(section);
    flow_.add(section);
    cover_.add(section);
    if (const auto speed = observables::wall_layer_speed(section, study_.radius, study_.diameter)) {
        wall_layer_sum_ += *speed;
        ++wall_layer_frames_;
    }
    coordination_sum_ += observables::coordination(state_, contacts_);
    for (const auto& contact : contacts_)
        if (contact.second < 0) rolling_sum_ += contact.rolling_moment[1];
    energy_sum_ += observables::translational_energy(state_, study_.material.density);
}

void Experiment::observe(Observations& into) const {
    record::particles.record(into, static_cast<double>(engine_->size()));
    kit::record_bond_number(into, study_.material, study_.diameter, study_.gravity);
    if (angle_.empty()) return;
    record::max_overlap.record(into, engine_->peak_overlap());
    observe_angles(into);
    observe_flow(into);
    if (finished()) observe_cover(into);
}

void Experiment::observe_angles(Observations& into) const {
    const auto n = static_cast<double>(angle_.size());
    double mean = 0, squares = 0;
    for (const double angle : angle_) mean += angle / n;
    for (const double angle : angle_) squares += (angle - mean) * (angle - mean) / n;
    record::angle_cm.record_known(into, mean);
    record::angle_cm_deviation.record_known(into, std::sqrt(squares));
    record::angle_cm_error.record_known(into, observables::block_standard_error(angle_, blocks));
    auto& series = record::angle_series.in(into);
    for (std::size_t k = 0; k < angle_.size(); ++k)
        series.push_back({.time = study_.time_of_frame(static_cast<std::int64_t>(k)), .value = angle_[k]});
}

void Experiment::observe_flow(Observations& into) const {
    const auto n = static_cast<double>(angle_.size());
    const observables::Line surface = solid_.surface_line(study_.radius);
    const auto below = flow_.below(surface);
    record::angle_surface.record_known(into, angle_of(surface));
    record::surface_residual.record_known(into, surface.residual / study_.diameter);
    record::surface_speed.record_known(into, below.surface_speed / study_.wall_speed());
    record::layer_depth.record_known(into, below.depth);
    if (wall_layer_frames_ > 0) {
        const double carried = study_.speed * (study_.radius - study_.diameter / 2);
        const double share = wall_layer_sum_ / static_cast<double>(wall_layer_frames_) / carried;
        record::wall_layer_speed.record(into, share);
        record::wall_slip.record(into, 1 - share);
    }
    record::coordination.record_known(into, coordination_sum_ / n);
    record::kinetic_energy.record(into, energy_sum_ / n);
    const double turned = study_.speed * (time() - study_.time_of_frame(0));
    if (turned > 0) record::torque.record(into, (work_done() - first_work_) / turned + rolling_sum_ / n);
}

void Experiment::observe_cover(Observations& into) const {
    const auto& grid = cover_.grid();
    const std::vector<double> share = cover_.share();
    auto& occupancy = record::occupancy.in(into);
    double area = 0;
    for (std::int64_t row = 0; row < grid.count; ++row)
        for (std::int64_t column = 0; column < grid.count; ++column) {
            if (std::hypot(grid.centre(column), grid.centre(row)) > study_.radius) continue;
            const std::size_t cell = grid.number(column, row);
            occupancy.push_back({.bin = static_cast<double>(cell), .value = share[cell]});
            if (share[cell] >= hidden) area += grid.cell * grid.cell;
        }
    record::cover_area.record(into, area);
    auto& surface = record::surface.in(into);
    for (const auto& [x, z] : observables::falling_through(grid, share, hidden, study_.radius))
        surface.push_back({.bin = x, .value = z});
    const auto angle_within = [&](double reach) {
        return angle_of(
            observables::fitted_line(observables::falling_through(grid, share, hidden, reach * study_.radius)));
    };
    record::angle_cover.record_known(into, angle_within(middle_half));
    record::angle_cover_middle.record_known(into, angle_within(middle_fifth));
}

Snapshot Experiment::snapshot() const {
    Snapshot picture = picture_of(*engine_);
    if (!study_.has_plates) picture.periods[1] = study_.length;
    const dem::Vec3 low{-study_.radius, 0, -study_.radius}, high{study_.radius, study_.length, study_.radius};
    for (std::size_t w = 0; w < walls_.size(); ++w)
        picture.walls.push_back(surface_of(walls_[w], names.at(w), low, high, engine_->wall_time()));
    return picture;
}

void Experiment::save(Bytes& into) const {
    kit::write_checkpoint(into, checkpoint_format, *engine_, [this](ByteWriter& out) {
        const auto put = [&out](const auto& value) { out.put(value); };
        put(step_);
        put(angle_);
        decltype(solid_)::fields(solid_, put);
        decltype(flow_)::fields(flow_, put);
        decltype(cover_)::fields(cover_, put);
        put(wall_layer_sum_);
        put(wall_layer_frames_);
        put(coordination_sum_);
        put(energy_sum_);
        put(rolling_sum_);
        put(first_work_);
    });
}

void Experiment::restore(std::span<const std::byte> from) {
    ByteReader in = kit::open_checkpoint(from, checkpoint_format);
    // A column has as many entries as the experiment has cells.
    const auto get = [&in]<class T>(T& value) {
        if constexpr (requires { value.size(); }) {
            const std::size_t size = value.size();
            in.get(value);
            in.require(value.size() == size);
        } else {
            in.get(value);
            in.require(value >= 0);
        }
    };
    in.get(step_);
    in.get(angle_);
    decltype(solid_)::fields(solid_, get);
    decltype(flow_)::fields(flow_, get);
    decltype(cover_)::fields(cover_, get);
    in.get(wall_layer_sum_);
    get(wall_layer_frames_);
    get(coordination_sum_);
    get(energy_sum_);
    in.get(rolling_sum_);
    in.get(first_work_);
    const Bytes engine = kit::engine_at_end(in);
    in.require(frames_taken() <= study_.frames && step_ >= 0 && step_ <= study_.last_step());
    in.require(frames_taken() == 0 || step_ >= study_.step_of_frame(frames_taken() - 1));
    in.require(frames_taken() == study_.frames || step_ < study_.step_of_frame(frames_taken()));
    engine_->restore(engine);
}

}  // namespace grainsweep::drum
