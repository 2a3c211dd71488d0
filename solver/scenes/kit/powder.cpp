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

dem::Surface Powder::wall_surface(const Inputs& inputs) const {
    dem::Surface surface{.friction = own(wall_friction, inputs),
                         .rolling_friction = own(wall_rolling_friction, inputs),
                         .restitution = own(wall_restitution, inputs, true)};
    const dem::CohesionLaw law = cohesion_law(inputs);
    if (!dem::acts_by_surface_energy(law)) {
        surface.cohesion = own(wall_cohesion, inputs);
        return surface;
    }
    surface.surface_energy = own(wall_surface_energy, inputs);
    const double of_powder = surface_energy(inputs), of_walls = surface.surface_energy.value_or(of_powder);
    if (law == dem::CohesionLaw::jkr && (of_powder > 0) != (of_walls > 0)) {
        char sentence[200];
        std::snprintf(sentence, sizeof sentence,
                      "wall_surface_energy is %.4g and surface_energy %.4g: 'jkr' needs both above 0, or neither; "
                      "give a small one, or cohesion_law 'dmt'",
                      of_walls, of_powder);
        throw std::invalid_argument(sentence);
    }
    return surface;
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

std::optional<double> own(const Real& property, const Inputs& inputs, bool positive) {
    const double value = property(inputs);
    if (value == as_powder) return std::nullopt;
    if (positive ? value > 0 : value >= 0) return value;
    char sentence[160];
    std::snprintf(sentence, sizeof sentence, "%.*s of %.4g is no property: give -1, as in the powder, or %s",
                  static_cast<int>(property.name.size()), property.name.data(), value,
                  positive ? "more than 0" : "at least 0");
    throw std::invalid_argument(sentence);
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
