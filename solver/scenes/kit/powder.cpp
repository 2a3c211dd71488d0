#include "solver/scenes/kit/powder.hpp"

#include "solver/dem/material.hpp"
#include "solver/dem/time_step.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <stdexcept>

namespace grainsweep::kit {
namespace {

/// Contact area over R d of two equal spheres, to first order in the overlap.
double area_factor(dem::CohesionLaw area) {
    switch (area) {
        case dem::CohesionLaw::sjkr2:
            return 2 * std::numbers::pi;
        case dem::CohesionLaw::paper:
            return std::numbers::pi / 4;
        default:
            return std::numbers::pi;
    }
}

}  // namespace

dem::Material Powder::material(const Inputs& inputs) const {
    dem::Material material;
    material.density = density(inputs);
    material.youngs_modulus = youngs_modulus(inputs);
    material.poisson_ratio = poisson_ratio(inputs);
    material.restitution = restitution(inputs);
    material.friction = friction(inputs);
    material.rolling_friction = rolling_friction(inputs);
    material.rolling_law = rolling_law(inputs);
    material.tangential_limit = tangential_limit(inputs);
    material.cohesion_law = cohesion_law(inputs);
    // the parameter of the other kind of law has no effect
    (dem::acts_by_surface_energy(material.cohesion_law) ? material.surface_energy : material.cohesion) =
        (dem::acts_by_surface_energy(material.cohesion_law) ? surface_energy : cohesion)(inputs);
    return material;
}

particles::SizeDistribution Powder::sizes(const Inputs& inputs, const Files& files) const {
    using particles::SizeDistribution;
    switch (size_distribution(inputs)) {
        case SizeLaw::weibull_wide:
            return SizeDistribution::weibull_classes(0.15);
        case SizeLaw::weibull_narrow:
            return SizeDistribution::weibull_classes(0.1);
        case SizeLaw::lognormal:
            return SizeDistribution::lognormal(size_spread(inputs));
        case SizeLaw::uniform:
            return SizeDistribution::uniform(size_spread(inputs));
        case SizeLaw::file:
            break;
        case SizeLaw::monodisperse:
            return {};
    }
    if (!size_file(inputs))
        throw std::invalid_argument("size_distribution is 'file': name the file of the sizes in size_file");
    const auto table = particles::SizeTable::read(size_file.contents(inputs, files)).over(diameter(inputs));
    if (!(table.smallest() <= 1 && table.largest() >= 1)) {
        char sentence[200];
        std::snprintf(sentence, sizeof sentence,
                      "diameter is %.4g m, and the sizes in size_file are %.4g to %.4g m: give one among them as the "
                      "unit of lengths",
                      diameter(inputs), table.smallest() * diameter(inputs), table.largest() * diameter(inputs));
        throw std::invalid_argument(sentence);
    }
    return SizeDistribution::table(table);
}

double Powder::step(const Inputs& inputs, double radius, double speed) const {
    if (const double given = time_step(inputs); given > 0) return given;
    const dem::Material of = material(inputs);
    return time_step_fraction(inputs) * dem::shortest_time(of, radius, speed);
}

std::optional<double> Powder::step_share(const Inputs& inputs) const {
    if (time_step(inputs) > 0) return std::nullopt;
    return dem::step_share(time_step_fraction(inputs));
}

dem::Method Powder::method(const Inputs& inputs) const {
    dem::Method method;
    method.precision = precision(inputs);
    return method;
}

double pull_off_force(const dem::Material& material, double diameter) {
    const double radius_of_pair = diameter / 4;
    if (material.cohesion_law == dem::CohesionLaw::jkr)
        return 1.5 * std::numbers::pi * material.surface_energy * radius_of_pair;
    if (material.cohesion_law == dem::CohesionLaw::dmt)
        return 2 * std::numbers::pi * material.surface_energy * radius_of_pair;
    // The largest value of a d - b d^(3/2), b = 4/3 E* sqrt(R*): 4 a^3/(27 b^2), R* = R/2.
    const double radius = diameter / 2;
    const double a = material.cohesion * area_factor(material.cohesion_law) * radius;
    const double modulus = dem::effective_modulus(material);
    return a * a * a / (6 * modulus * modulus * radius);
}

void record_bond_number(Observations& into, const dem::Material& material, double diameter, double gravity) {
    if (!(material.cohesion > 0 || material.surface_energy > 0)) return;
    const double weight = dem::sphere_mass(diameter / 2, material.density) * gravity;
    bond_number.record(into, pull_off_force(material, diameter) / weight);
}

}  // namespace grainsweep::kit
