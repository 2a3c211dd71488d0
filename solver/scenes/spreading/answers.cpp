#include "solver/observables/series.hpp"
#include "solver/scenes/spreading/experiment.hpp"
#include "solver/scenes/spreading/filling.hpp"
#include "solver/scenes/spreading/record.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace grainsweep::spreading {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t blocks = 10;     // of the measured flux, 5 mm of travel each by default
constexpr double relief_pitch = 0.25;  // in diameters
constexpr double patch_side = 5;       // in diameters
constexpr double most_bare = 0.5;      // share of bare base beyond which the powder is no layer
constexpr double densest = 0.64;       // random close packing of equal spheres (Scott & Kilgour 1969)
constexpr double densest_of_unequal = 1 - (1 - densest) * (1 - densest);  // small ones in the pores (Furnas 1931)

void record_known(const kit::Scalar& observable, Observations& into, double value) {
    if (!std::isnan(value)) observable.record(into, value);
}

}  // namespace

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

/// Mass flow rate of one sphere of diameter D per second in units of the gap swept by the tool, filled solid.
double Experiment::flux_scale() const {
    return study_.particle_mass() / (study_.width * study_.gap * study_.speed * study_.material.density);
}

double Experiment::mean_flux() const {
    const std::size_t first = first_measured_sample;
    const std::size_t last = behind_.size() - 1;
    return flux_scale() * (behind_[last] - behind_[first]) / (time_of_sample(last) - time_of_sample(first));
}

void Experiment::observe(Observations& into) const {
    record::particles.record(into,
                             static_cast<double>(static_cast<std::int64_t>(engine_->size()) - glued_particles(study_)));
    kit::record_bond_number(into, study_.material, study_.diameter, study_.gravity);
    if (!sweeping_) return;
    record::max_overlap.record(into, std::max(earlier_overlap_, engine_->peak_overlap()));
    observe_flux(into);
    observe_tool(into);
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

    record::mfr.record(into, mean_flux());
    // Where nothing has passed, the blocks have no spread, and that says nothing of the error.
    const bool passed = std::ranges::any_of(flux, [](double value) { return value != 0; });
    if (const double error = observables::block_standard_error(flux, blocks); passed && !std::isnan(error))
        record::mfr_standard_error.record(into, error);
    observe_profile(into);
    if (study_.tool != Tool::blade) return;
    const std::size_t first = first_measured_sample;
    const std::size_t last = behind_.size() - 1;
    double mean = 0;
    for (std::size_t k = first; k <= last; ++k) mean += under_[k];
    mean /= static_cast<double>(last - first + 1);
    const double mass = mean * study_.particle_mass();
    const double slot = study_.width * study_.gap * study_.material.density;
    record::mfr_window.record(into, mass / (slot * study_.blade_thickness));
    record::mfr_thesis.record(into, mass / (slot * study_.speed));
}

void Experiment::observe_profile(Observations& into) const {
    const std::size_t first = first_measured_sample;
    const std::size_t last = behind_.size() - 1;
    std::vector<double> velocity;
    // Only layers with on average at least one particle per sample count as powder ahead of the tool. A single particle
    // thrown up crosses several layers at the same velocity, which would give a false uniform profile.
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

void Experiment::observe_tool(Observations& into) const {
    const double first_place = study_.edge(measured_from * time_of_sample(static_cast<std::size_t>(sweep_samples)));
    double sum = 0;
    std::int64_t samples = 0;
    for (std::size_t k = 0; k < solid_.size(); ++k) {
        if (study_.rear(time_of_sample(k)) - behind_to * study_.diameter < first_place) continue;
        sum += solid_[k];
        ++samples;
    }
    if (samples > 0) record::solid_behind.record(into, sum / static_cast<double>(samples));
    const auto measured = static_cast<std::int64_t>(behind_.size()) - first_measured_sample;
    if (measured <= 0) return;
    record::tool_force.record(into, force_sum_ / (static_cast<double>(measured) * study_.width));
    record::tool_lift.record(into, lift_sum_ / (static_cast<double>(measured) * study_.width));
}

/// Over what lies from where the flux became steady to behind the tool, where the powder has come to rest.
LayerAnswer Experiment::layer_answer() const {
    LayerAnswer answer;
    answer.mfr = mean_flux();
    const auto measured = static_cast<double>(static_cast<std::int64_t>(behind_.size()) - first_measured_sample);
    answer.force = force_sum_ / (measured * study_.width);
    const double end = time_of_sample(static_cast<std::size_t>(end_sample_));
    const double from = study_.edge(measured_from * time_of_sample(static_cast<std::size_t>(sweep_samples)));
    const double to = study_.rear(end) - study_.clearance;
    if (!(to > from)) return answer;
    const dem::State state = powder();
    const double gained = observables::solid_volume(state, from, to) - observables::solid_volume(bed_, from, to);
    answer.packing_fraction = gained / ((to - from) * study_.width * study_.gap);
    // Of spheres that stick out over the gap, or fill what the layers below have left open.
    if (answer.packing_fraction > (study_.sizes.equal() ? densest : densest_of_unequal)) answer.packing_fraction = nan;
    observables::Patches patches(from, to, study_.width, patch_side * study_.diameter);
    patches.add(state);
    patches.add(bed_, -1);
    answer.patch_sd = patches.deviation() / (patches.area() * study_.gap);
    const observables::Relief relief(state, from, to, study_.width, relief_pitch * study_.diameter);
    if (layer_ == 0) {
        answer.empty_share = relief.empty_share();
    } else {
        dem::State supplied;
        for (std::size_t k = 0; k < state.id.size(); ++k) {
            if (volume_[static_cast<std::size_t>(state.id[k])] == 0) continue;
            supplied.position.push_back(state.position[k]);
            supplied.radius.push_back(state.radius[k]);
        }
        answer.empty_share =
            observables::Relief(supplied, from, to, study_.width, relief_pitch * study_.diameter).empty_share();
    }
    // Single particles on the bare base deviate from its height the less, the fewer they are: not a smooth layer.
    if (answer.empty_share <= most_bare) answer.roughness = relief.roughness() / study_.diameter;
    return answer;
}

void Experiment::observe_layer(Observations& into) const {
    const LayerAnswer answer = layer_answer();
    record_known(record::packing_fraction, into, answer.packing_fraction);
    record_known(record::empty_share, into, answer.empty_share);
    record_known(record::layer_roughness, into, answer.roughness);
    record_known(record::patch_sd, into, answer.patch_sd);
    if (study_.layers > 1) observe_layers(into, answer);
}

void Experiment::observe_layers(Observations& into, const LayerAnswer& last) const {
    auto all = layers_;
    all.push_back(last);
    const auto list = [&](const kit::Profile& profile, double LayerAnswer::*value) {
        auto& samples = profile.in(into);
        for (std::size_t k = 0; k < all.size(); ++k)
            samples.push_back({.time = nan, .bin = static_cast<double>(k + 1), .value = all[k].*value});
    };
    list(record::mfr_by_layer, &LayerAnswer::mfr);
    list(record::packing_by_layer, &LayerAnswer::packing_fraction);
    list(record::patch_sd_by_layer, &LayerAnswer::patch_sd);
    list(record::roughness_by_layer, &LayerAnswer::roughness);
    list(record::empty_share_by_layer, &LayerAnswer::empty_share);
    list(record::force_by_layer, &LayerAnswer::force);
    const double end = time_of_sample(static_cast<std::size_t>(end_sample_));
    const double from = study_.edge(measured_from * time_of_sample(static_cast<std::size_t>(sweep_samples)));
    const double to = study_.rear(end) - study_.clearance;
    if (!(to > from)) return;
    const dem::State state = powder();
    auto& slabs = record::bed_packing.in(into);
    for (std::int64_t k = 0; k < study_.layers; ++k)
        slabs.push_back({.time = nan,
                         .bin = static_cast<double>(k + 1),
                         .value = observables::solid_between(state, from, to, study_.level(k), study_.level(k + 1)) /
                                  ((to - from) * study_.width * study_.gap)});
}

}  // namespace grainsweep::spreading
