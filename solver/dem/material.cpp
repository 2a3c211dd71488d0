#include "solver/dem/material.hpp"

#include "solver/dem/walls/wall.hpp"

#include <cmath>
#include <numbers>

namespace grainsweep::dem {

double effective_modulus(const Material& m) {
    if (!m.partner) return m.youngs_modulus / (2 * (1 - m.poisson_ratio * m.poisson_ratio));
    const auto compliance = [](double modulus, double ratio) { return (1 - ratio * ratio) / modulus; };
    return 1 / (compliance(m.youngs_modulus, m.poisson_ratio) +
                compliance(m.partner->youngs_modulus, m.partner->poisson_ratio));
}

double effective_shear_modulus(const Material& m) {
    if (!m.partner) return m.youngs_modulus / (4 * (2 - m.poisson_ratio) * (1 + m.poisson_ratio));
    const auto compliance = [](double modulus, double ratio) { return 2 * (2 - ratio) * (1 + ratio) / modulus; };
    return 1 / (compliance(m.youngs_modulus, m.poisson_ratio) +
                compliance(m.partner->youngs_modulus, m.partner->poisson_ratio));
}

double normal_slope(const Material& m) {
    return m.normal_law == NormalLaw::linear ? m.stiffness : 2 * effective_modulus(m);
}

double damping_ratio(double restitution) {
    const double l = std::log(restitution);
    return l / std::hypot(l, std::numbers::pi);
}

double damping_factor(double restitution) {
    return -2 * std::sqrt(5.0 / 6.0) * damping_ratio(restitution);
}

double pull_back_share(const Material& m) {
    const double z = -damping_ratio(m.restitution);
    if (m.tangential_limit == TangentialLimit::spring || !(z > 0)) return 0;
    return std::sqrt(m.restitution) * std::sinh(z * std::asin(z) / std::sqrt(1 - z * z)) / z;
}

double sphere_mass(double radius, double density) {
    return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius * density;
}

Material at_surface(const Material& material, const Surface& surface) {
    Material m = material;
    m.friction = surface.friction.value_or(m.friction);
    m.rolling_friction = surface.rolling_friction.value_or(m.rolling_friction);
    m.restitution = surface.restitution.value_or(m.restitution);
    m.cohesion = surface.cohesion.value_or(m.cohesion);
    m.surface_energy = surface.surface_energy.value_or(m.surface_energy);
    return m;
}

}  // namespace grainsweep::dem
