#include "solver/scenes/kit/powder.hpp"

#include "solver/dem/material.hpp"

#include <numbers>

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

}  // namespace grainsweep::kit
