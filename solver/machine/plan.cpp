#include "solver/machine/plan.hpp"

#include "solver/machine/setup.hpp"
#include "solver/scenes/kit/pace.hpp"
#include "solver/scenes/kit/sentence.hpp"

#include <algorithm>
#include <cmath>

namespace grainsweep::machine {
namespace {

using kit::sentence;

constexpr double early = 0.5;        // of a phase that may end before its time
constexpr double softest = 0.1;      // overlap over diameter
constexpr double most_loose = 0.35;  // solid fraction of what is thrown in at random

double mean_mass(const Spec& spec, const Mix& mix) {
    double mass = 0;
    for (const auto& [species, share] : mix)
        mass += share * spec.species[species].mean_volume() * spec.densities[spec.species[species].material];
    return mass;
}

double mean_volume(const Spec& spec, const Mix& mix) {
    double volume = 0;
    for (const auto& [species, share] : mix) volume += share * spec.species[species].mean_volume();
    return volume;
}

double duration_of(const Spec& spec, const Phases& during) {
    double seconds = 0;
    for (std::size_t p = 0; p < spec.phases.size(); ++p)
        if (holds(during, p)) seconds += spec.phases[p].duration * (spec.phases[p].until.empty() ? 1 : early);
    return seconds;
}

double particles_at_start(const Spec& spec) {
    double count = 0;
    for (const auto& fill : spec.fills) {
        const auto* region = std::get_if<Fill>(&fill);
        count += region != nullptr ? static_cast<double>(region->count)
                                   : static_cast<double>(std::get<std::vector<Placed>>(fill).size());
    }
    return count;
}

void warn_of_softness(const Spec& spec, std::vector<Warning>& warnings) {
    const double speed = fastest_of(spec);
    for (const Species& species : spec.species) {
        dem::Material material = spec.pairs[dem::place_of_pair(species.material, species.material)];
        material.density = spec.densities[species.material];
        const double overlap = kit::impact_overlap(material, species.largest(), speed);
        if (overlap <= softest) continue;
        warnings.push_back({"particles too soft for the fall",
                            species.name + sentence(": at %.3g m/s, the fastest impact expected, particles of this "
                                                    "stiffness overlap by about %.2g of a diameter, and contact laws "
                                                    "hold for small overlaps: raise youngs_modulus",
                                                    speed, overlap)});
        return;
    }
}

void warn_of_feeds(const Spec& spec, std::vector<Warning>& warnings) {
    for (const Feed& feed : spec.feeds) {
        const auto volume = feed.through.volume();
        if (!volume) continue;
        const double count = feed.rate * feed.interval / mean_mass(spec, feed.mix);
        const double solid = count * mean_volume(spec, feed.mix) / *volume;
        if (solid > most_loose)
            warnings.push_back(
                {"a feed that cannot keep up",
                 feed.name + sentence(": a batch would fill %.2g of its region with spheres, and at most "
                                      "%.2g find a place: enlarge the region, or raise its velocity",
                                      solid, most_loose)});
    }
}

}  // namespace

CostEstimate cost_of(const Spec& spec) {
    double work = 0, most = particles_at_start(spec);
    work += most * duration_of(spec, {});
    for (const Feed& feed : spec.feeds) {
        // What is fed stays for half of the time, in the mean.
        const double fed = feed.rate * duration_of(spec, feed.during) / mean_mass(spec, feed.mix);
        work += fed * duration_of(spec, feed.during) / 2;
        most += fed;
    }
    const double steps = duration_of(spec, {}) / spec.time_step;
    return kit::estimate(spec.method, spec.pairs.front(), most, most > 0 ? work / spec.time_step / most : steps);
}

std::vector<Warning> warnings_of(const Spec& spec) {
    std::vector<Warning> warnings = spec.warnings;
    warn_of_softness(spec, warnings);
    warn_of_feeds(spec, warnings);
    return warnings;
}

}  // namespace grainsweep::machine
