#include "solver/scenes/spreading/experiment.hpp"

#include "solver/particles/bytes.hpp"
#include "solver/scenes/dem_picture.hpp"
#include "solver/scenes/spreading/record.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grainsweep::spreading {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint64_t checkpoint_format = 0x6772'6e73'7370'0003ULL;  // "grnssp", version 3
constexpr std::size_t blocks = 10;       // of the measured flux, 5 mm of travel each by default
constexpr double layer_thickness = 0.5;  // of the velocity profile, in diameters
constexpr double profile_reach = 6;      // ahead of the blade, in diameters
constexpr double relief_pitch = 0.25;    // in diameters
constexpr double most_bare = 0.5;        // share of the base beyond which what lies on it is no layer

}  // namespace

Experiment::Experiment(const Study& study, std::uint64_t seed, const dem::Method& method, Artefacts& artefacts)
    : study_(study), artefacts_(artefacts) {
    const bool shared = study_.bed_seed > 0;
    const dem::Setup setup = settling(study_, shared ? seed_of_bed(study_.bed_seed) : seed);
    if (shared) study_.blade_start -= run_up(study_, seed);
    domain_ = setup.domain;
    gates_ = setup.walls;
    volume_.reserve(setup.spheres.size());
    for (const auto& sphere : setup.spheres) {
        const double d = 2 * sphere.radius / study_.diameter;
        volume_.push_back(d * d * d);
    }
    place_.assign(volume_.size(), Place::ahead);
    if (shared) engine_ = settled_before(setup, method);
    if (engine_) {
        step_ = study_.settle_steps;
        borrowed_particle_steps_ = engine_->work().particle_steps;
    } else {
        engine_ = dem::make_engine(setup, method);
    }
    if (step_ == study_.settle_steps) start_sweep();
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
    }
}

void Experiment::end_settling() {
    if (study_.bed_seed > 0) {
        Bytes bed;
        engine_->save(bed);
        artefacts_.put(study_.bed_key, bed);
    }
    start_sweep();
}

void Experiment::start_sweep() {
    engine_->forget_peak_overlap();
    engine_->set_walls(sweeping_walls(study_));
    sweeping_ = true;
    sample();
}

/// A particle that has left the box is on the side of the front face where it was last: the open faces are further
/// from the blade than anything moves between two samples.
void Experiment::count_left(double front) {
    std::size_t k = 0;  // of the state, in which ids ascend
    for (std::size_t id = 0; id < place_.size(); ++id) {
        if (k < state_.id.size() && static_cast<std::size_t>(state_.id[k]) == id) {
            place_[id] = state_.position[k++][0] < front ? Place::behind : Place::ahead;
        } else {
            if (place_[id] == Place::behind) left_behind_ += volume_[id];
            place_[id] = Place::left;
        }
    }
}

void Experiment::sample() {
    const double time = time_of_sample(behind_.size());
    engine_->state(state_);
    count_left(study_.front(time));
    behind_.push_back(observables::sum_behind(state_, volume_, study_.front(time)) + left_behind_);
    under_.push_back(observables::sum_under(state_, volume_, study_.rear(time), study_.front(time), study_.gap));
    if (static_cast<std::int64_t>(behind_.size()) > first_measured_sample)
        profile_.add(state_, study_.front(time), study_.front(time) + profile_reach * study_.diameter, study_.gap,
                     layer_thickness * study_.diameter);
    if (known_well_enough()) end_sample_ = static_cast<std::int64_t>(behind_.size()) - 1;
}

bool Experiment::known_well_enough() const {
    if (!(study_.standard_error > 0)) return false;
    const auto measured = static_cast<std::int64_t>(behind_.size()) - 1 - first_measured_sample;
    if (measured < least_measured_samples || measured % samples_between_looks != 0) return false;
    return observables::block_standard_error(measured_flux(), blocks) < study_.standard_error;
}

/// mfr of each sample interval from t1.
std::vector<double> Experiment::measured_flux() const {
    std::vector<double> flux;
    for (std::size_t k = first_measured_sample + 1; k < behind_.size(); ++k)
        flux.push_back(flux_scale() * (behind_[k] - behind_[k - 1]) / (time_of_sample(k) - time_of_sample(k - 1)));
    return flux;
}

/// Mass flow rate of one sphere of diameter D per second in units of the gap swept by the blade, filled solid.
double Experiment::flux_scale() const {
    return study_.particle_mass() / (study_.width * study_.gap * study_.speed * study_.material.density);
}

void Experiment::observe(Observations& into) const {
    record::particles.record(into, static_cast<double>(engine_->size()));
    kit::record_bond_number(into, study_.material, study_.diameter, study_.gravity);
    if (!sweeping_) return;
    record::max_overlap.record(into, engine_->peak_overlap());
    observe_flux(into);
    if (!finished()) return;
    record::end_of_travel.record(into, study_.speed * time_of_sample(static_cast<std::size_t>(end_sample_)));
    observe_layer(into);
}

void Experiment::observe_flux(Observations& into) const {
    auto& series = record::flux_series.in(into);
    for (std::size_t k = 1; k < behind_.size(); ++k) {
        const double value = flux_scale() * (behind_[k] - behind_[k - 1]) / (time_of_sample(k) - time_of_sample(k - 1));
        series.push_back({.time = time_of_sample(k), .bin = nan, .value = value});
    }
    const std::vector<double> flux = measured_flux();
    if (flux.empty()) return;

    const std::size_t first = first_measured_sample;
    const std::size_t last = behind_.size() - 1;
    record::mfr.record(
        into, flux_scale() * (behind_[last] - behind_[first]) / (time_of_sample(last) - time_of_sample(first)));
    // Where nothing has passed, the blocks have no spread, and that says nothing of the error.
    const bool passed = std::ranges::any_of(flux, [](double value) { return value != 0; });
    if (const double error = observables::block_standard_error(flux, blocks); passed && !std::isnan(error))
        record::mfr_standard_error.record(into, error);
    double mean = 0;
    for (std::size_t k = first; k <= last; ++k) mean += under_[k];
    mean /= static_cast<double>(last - first + 1);
    const double mass = mean * study_.particle_mass();
    const double slot = study_.width * study_.gap * study_.material.density;
    record::mfr_window.record(into, mass / (slot * study_.blade_thickness));
    record::mfr_thesis.record(into, mass / (slot * study_.speed));

    std::vector<double> velocity;
    // Ahead of the blade lies powder only where layers hold a particle per sample on average: one thrown up crosses
    // several at the same velocity, which is no even profile.
    std::size_t filled = 0, most_filled = 0;  // neighbouring layers
    auto& profile = record::vx_profile.in(into);
    for (std::size_t k = 0; k < profile_layers; ++k) {
        const auto n = profile_.samples[k];
        filled = n > static_cast<std::int64_t>(last - first) ? filled + 1 : 0;
        most_filled = std::max(most_filled, filled);
        velocity.push_back(n > 0 ? profile_.sum[k] / static_cast<double>(n) : nan);
        profile.push_back({.time = nan, .bin = layer_thickness * static_cast<double>(k + 1), .value = velocity[k]});
    }
    if (most_filled >= 3) record::vx_unevenness.record(into, observables::unevenness(velocity) / study_.speed);
}

void Experiment::observe_layer(Observations& into) const {
    // From where the flux became steady to one thickness behind the blade, where the powder has come to rest.
    const double end = time_of_sample(static_cast<std::size_t>(end_sample_));
    const double from = study_.front(measured_from * time_of_sample(static_cast<std::size_t>(sweep_samples)));
    const double to = study_.rear(end) - study_.blade_thickness;
    if (!(to > from)) return;
    dem::State state;
    engine_->state(state);
    const observables::Relief relief(state, from, to, study_.width, relief_pitch * study_.diameter);
    record::packing_fraction.record(
        into, observables::solid_volume(state, from, to) / ((to - from) * study_.width * study_.gap));
    record::empty_share.record(into, relief.empty_share());
    // Single particles on the bare base deviate from its height the less, the fewer they are: not a smooth layer.
    if (relief.empty_share() <= most_bare) record::layer_roughness.record(into, relief.roughness() / study_.diameter);
}

double Experiment::progress() const {
    return static_cast<double>(step_) / static_cast<double>(last_step());
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
        const auto walls = sweeping_walls(study_);
        add(walls.at(0), "base");
        add(walls.at(1), "blade");
    } else {
        add(gates_.at(0), "base");
        add(gates_.at(1), "first_gate");
        add(gates_.at(2), "second_gate");
    }
    return picture;
}

void Experiment::save(Bytes& into) const {
    into.clear();
    Bytes engine;
    engine_->save(engine);
    particles::ByteWriter out(into);
    out.put(checkpoint_format);
    out.put(step_);
    out.put(sweeping_);
    out.put(borrowed_particle_steps_);
    out.put(end_sample_);
    out.put(behind_);
    out.put(under_);
    out.put(place_);
    out.put(left_behind_);
    out.put(profile_.sum);
    out.put(profile_.samples);
    out.put(engine);
}

void Experiment::restore(std::span<const std::byte> from) {
    particles::ByteReader in(from);
    std::uint64_t format = 0;
    in.get(format);
    if (format != checkpoint_format) throw std::invalid_argument("checkpoint of another scene");
    Bytes engine;
    in.get(step_);
    in.get(sweeping_);
    in.get(borrowed_particle_steps_);
    in.get(end_sample_);
    in.get(behind_);
    in.get(under_);
    in.get(place_);
    in.get(left_behind_);
    in.get(profile_.sum);
    in.get(profile_.samples);
    in.get(engine);
    in.finish();
    const auto samples = static_cast<std::int64_t>(behind_.size());
    in.require(end_sample_ >= 0 && end_sample_ <= sweep_samples && place_.size() == volume_.size());
    in.require(under_.size() == behind_.size() && samples <= sweep_samples + 1 && sweeping_ == (samples > 0));
    in.require(step_ >= 0 && step_ <= (sweeping_ ? last_step() : study_.settle_steps));
    in.require(!sweeping_ || (step_ >= step_of_sample(samples - 1) && step_ <= step_of_sample(samples)));
    in.require(profile_.sum.size() == profile_layers && profile_.samples.size() == profile_layers);
    engine_->restore(engine);
}

}  // namespace grainsweep::spreading
