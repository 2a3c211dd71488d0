#include "solver/dem/material.hpp"

#include <cmath>
#include <numbers>

namespace grainsweep::dem {
namespace {

/// 2 sqrt(5/6): makes the damped Hertz contact's restitution independent of the impact speed.
const double two_sqrt_five_sixths = 2 * std::sqrt(5.0 / 6.0);

}  // namespace

double effective_modulus(const Material& m) {
    return m.youngs_modulus / (2 * (1 - m.poisson_ratio * m.poisson_ratio));
}

double effective_shear_modulus(const Material& m) {
    return m.youngs_modulus / (4 * (2 - m.poisson_ratio) * (1 + m.poisson_ratio));
}

double damping_ratio(double restitution) {
    const double l = std::log(restitution);
    return l / std::hypot(l, std::numbers::pi);
}

double sphere_mass(double radius, double density) {
    return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius * density;
}

Material at_surface(const Material& material, const Surface& surface) {
    Material m = material;
    m.friction = surface.friction.value_or(m.friction);
    m.rolling_friction = surface.rolling_friction.value_or(m.rolling_friction);
    m.restitution = surface.restitution.value_or(m.restitution);
    return m;
}

Hertz hertz(const Material& m) {
    const double modulus = effective_modulus(m);
    return {.stiffness = 4.0 / 3.0 * modulus,
            .damping = -two_sqrt_five_sixths * damping_ratio(m.restitution) * std::sqrt(2 * modulus)};
}

Mindlin mindlin(const Material& m, double time_step) {
    const double stiffness = 8 * effective_shear_modulus(m);
    return {
        .stiffness = stiffness,
        .damping = m.friction > 0 ? -two_sqrt_five_sixths * damping_ratio(m.restitution) * std::sqrt(stiffness) : 0.0,
        .friction = m.friction,
        .time_step = time_step};
}

RollingResistance rolling_resistance(const Material& m, double time_step) {
    return {.stiffness = 2.25 * m.rolling_friction * m.rolling_friction * hertz(m).stiffness,
            .friction = m.rolling_friction,
            .damping_ratio = m.rolling_damping,
            .time_step = time_step};
}

}  // namespace grainsweep::dem
