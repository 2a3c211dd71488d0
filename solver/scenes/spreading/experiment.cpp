#include "solver/scenes/spreading/experiment.hpp"

#include "solver/scenes/dem_picture.hpp"
#include "solver/scenes/spreading/filling.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace grainsweep::spreading {
namespace {

constexpr double profile_reach = 6;  // ahead of the edge, in diameters
constexpr double behind_from = 5;    // of solid_behind, in diameters
constexpr std::array tool_names = {"blade", "roller", "tool"};

}  // namespace

Experiment::Experiment(const Study& study, std::uint64_t seed, const dem::Method& method, Artefacts& artefacts)
    : study_(study), seed_(seed), method_(method), artefacts_(artefacts) {
    const bool shared = study_.bed_seed > 0;
    if (shared) study_.blade_start -= run_up(study_, seed);
    const dem::Setup setup = setup_of_layer();
    take_over(setup);
    if (shared) engine_ = settled_before(setup, method);
    if (engine_) {
        step_ = study_.settle_steps;
        borrowed_particle_steps_ = engine_->work().particle_steps;
    } else {
        engine_ = dem::make_engine(setup, method);
    }
    if (step_ == study_.settle_steps) start_sweep();
}

dem::Setup Experiment::setup_of_layer() const {
    return settling(study_, study_.bed_seed > 0 ? seed_of_bed(study_.bed_seed) : seed_, layer_, bed_);
}

void Experiment::take_over(const dem::Setup& setup) {
    domain_ = setup.domain;
    gates_ = setup.walls;
    const std::size_t glued = static_cast<std::size_t>(glued_particles(study_));
    const std::size_t supplied = setup.spheres.size() - bed_.position.size() - glued;
    volume_.assign(setup.spheres.size(), 0);
    for (std::size_t k = 0; k < supplied; ++k) {
        const double d = 2 * setup.spheres[k].radius / study_.diameter;
        volume_[k] = d * d * d;
    }
    place_.assign(volume_.size(), Place::ahead);
}

void Experiment::supply(const dem::State& bed) {
    bed_ = bed;
    const dem::Setup setup = setup_of_layer();
    take_over(setup);
    engine_ = dem::make_engine(setup, method_);
    borrowed_particle_steps_ = 0;
    sweeping_ = false;
    behind_.clear();
    under_.clear();
    solid_.clear();
    force_sum_ = lift_sum_ = left_behind_ = 0;
    impulse_ = {};
    profile_ = observables::VelocityProfile(profile_layers);
}

/// Records the results of a layer, and removes the powder beside the platform.
void Experiment::next_layer() {
    layers_.push_back(layer_answer());
    earlier_particle_steps_ = particle_steps();
    earlier_overlap_ = std::max(earlier_overlap_, engine_->peak_overlap());
    engine_->state(state_);
    const dem::State bed = left_on_platform(study_, layer_, state_);
    ++layer_;
    step_ = 0;
    supply(bed);
    if (study_.settle_steps == 0) start_sweep();
}

std::unique_ptr<dem::Engine> Experiment::settled_before(const dem::Setup& setup, const dem::Method& method) {
    const auto bed = artefacts_.get(study_.bed_key);
    if (!bed) return nullptr;
    auto engine = dem::make_engine(setup, method);
    try {
        engine->restore(*bed);
    } catch (const std::invalid_argument&) {
        return nullptr;  // of another build: settle it anew
    }
    return engine;
}

std::int64_t Experiment::step_of_sample(std::int64_t sample) const {
    return study_.settle_steps + (study_.sweep_steps * sample + sweep_samples / 2) / sweep_samples;
}

double Experiment::time_of_sample(std::size_t sample) const {
    return study_.time_step *
           static_cast<double>(step_of_sample(static_cast<std::int64_t>(sample)) - study_.settle_steps);
}

void Experiment::advance(double until) {
    while (!finished() && health().stable() && time() < until) {
        // Stops are fixed by the experiment: the end of settling and the samples. A slice may only add a pause.
        const std::int64_t stop =
            sweeping_ ? step_of_sample(static_cast<std::int64_t>(behind_.size())) : study_.settle_steps;
        const double left = std::ceil((until - time()) / study_.time_step);
        const std::int64_t most = stop - step_;
        const std::int64_t steps =
            left < static_cast<double>(most) ? std::max<std::int64_t>(1, std::llround(left)) : most;
        const std::int64_t before = engine_->work().steps;
        engine_->run(steps);
        step_ += engine_->work().steps - before;
        if (!health().stable()) return;
        if (step_ < stop) continue;
        if (sweeping_)
            sample();
        else
            end_settling();
        if (step_ == last_step() && !finished()) next_layer();
    }
}

void Experiment::end_settling() {
    if (study_.bed_seed > 0 && layer_ == 0) {
        Bytes bed;
        engine_->save(bed);
        artefacts_.put(study_.bed_key, bed);
    }
    start_sweep();
}

void Experiment::start_sweep() {
    engine_->forget_peak_overlap();
    engine_->set_walls(sweeping_walls(study_, layer_));
    sweeping_ = true;
    sample();
}

/// Counts the particles that have left the box on their last side of the edge. The open faces are farther from the tool
/// than particles move between two samples.
void Experiment::count_left(double edge) {
    std::size_t k = 0;  // of the state, in which ids ascend
    for (std::size_t id = 0; id < place_.size(); ++id) {
        if (k < state_.id.size() && static_cast<std::size_t>(state_.id[k]) == id) {
            place_[id] = state_.position[k++][0] < edge ? Place::behind : Place::ahead;
        } else {
            if (place_[id] == Place::behind) left_behind_ += volume_[id];
            place_[id] = Place::left;
        }
    }
}

void Experiment::sample() {
    const double time = time_of_sample(behind_.size()), d = study_.diameter, level = study_.level(layer_);
    const double edge = study_.edge(time), rear = study_.rear(time);
    engine_->state(state_);
    count_left(edge);
    behind_.push_back(observables::sum_behind(state_, volume_, edge) + left_behind_);
    under_.push_back(observables::sum_under(state_, volume_, rear, edge, level + study_.gap));
    const double below = layer_ > 0 ? level : -0.49 * d;  // above the particles glued to the base
    solid_.push_back(
        observables::solid_volume(state_, rear - behind_to * d, rear - behind_from * d, below, level + study_.gap) /
        ((behind_to - behind_from) * d * study_.width * study_.gap));
    const geometry::Vec3 impulse = engine_->wall_load(1, {}).impulse, before = std::exchange(impulse_, impulse);
    if (static_cast<std::int64_t>(behind_.size()) > first_measured_sample) {
        profile_.add(state_, edge, edge + profile_reach * d, level + study_.gap, layer_thickness * d);
        const double since = time - time_of_sample(behind_.size() - 2);
        force_sum_ -= (impulse[0] - before[0]) / since;
        lift_sum_ += (impulse[2] - before[2]) / since;
    }
    if (known_well_enough()) end_sample_ = static_cast<std::int64_t>(behind_.size()) - 1;
}

dem::State Experiment::powder() const {
    dem::State state;
    engine_->state(state);
    if (study_.base == Base::smooth) return state;
    const auto all = state.id.size();  // glued particles come last
    const auto kept = all - static_cast<std::size_t>(std::ranges::count(state.mobile, char{0}));
    state.id.resize(kept);
    state.position.resize(kept);
    state.velocity.resize(kept);
    state.angular_velocity.resize(kept);
    state.radius.resize(kept);
    state.mobile.resize(kept);
    return state;
}

double Experiment::progress() const {
    if (study_.layers == 1) return static_cast<double>(step_) / static_cast<double>(last_step());
    const std::int64_t all = study_.layers * study_.steps_of_layer();
    return static_cast<double>(layer_ * study_.steps_of_layer() + step_) / static_cast<double>(all);
}

Snapshot Experiment::snapshot() const {
    Snapshot picture = picture_of(*engine_);
    picture.periods[1] = study_.width;
    const dem::Vec3 low = {domain_.low[0], 0, domain_.low[2]};
    const dem::Vec3 high = {domain_.high[0], study_.width, domain_.high[2]};
    const auto add = [&](const dem::Wall& wall, const char* name) {
        picture.walls.push_back(surface_of(wall, name, low, high, engine_->wall_time()));
    };
    if (sweeping_) {
        const auto walls = sweeping_walls(study_, layer_);
        add(walls.at(0), "base");
        add(walls.at(1), tool_names.at(static_cast<std::size_t>(study_.tool)));
        if (layer_ > 0) {
            add(walls.at(2), "base_before");
            add(walls.at(3), "base_beyond");
        }
    } else {
        add(gates_.at(0), "base");
        add(gates_.at(1), "first_gate");
        add(gates_.at(2), "second_gate");
        if (layer_ > 0) add(gates_.at(3), "base_beyond");
    }
    return picture;
}

}  // namespace grainsweep::spreading
