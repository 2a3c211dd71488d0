#include "solver/dem/time_step.hpp"

#include "solver/dem/material.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grainsweep::dem {

double rayleigh_time(const Material& m, double radius) {
    const double shear_modulus = m.youngs_modulus / (2 * (1 + m.poisson_ratio));
    return std::numbers::pi * radius * std::sqrt(m.density / shear_modulus) / (0.1631 * m.poisson_ratio + 0.8766);
}

double hertz_contact_time(const Material& m, double radius, double speed) {
    const double mass = sphere_mass(radius, m.density) / 2;
    const double modulus = effective_modulus(m);
    // 2.868 = (15/16)^(2/5) times twice the integral of dx / sqrt(1 - x^(5/2)) over [0, 1].
    return 2.868 * std::pow(mass * mass / (radius / 2 * modulus * modulus * speed), 0.2);
}

double linear_contact_time(const Material& m, double radius) {
    return std::numbers::pi * std::sqrt(sphere_mass(radius, m.density) / 2 / m.stiffness);
}

double impact_limit(const Material& m, double radius, double speed) {
    return m.normal_law == NormalLaw::linear ? part_of_linear_impact * linear_contact_time(m, radius)
                                             : hertz_contact_time(m, radius, speed);
}

double shortest_time(const Material& m, double radius, double speed) {
    const double impact = impact_limit(m, radius, speed);
    return m.normal_law == NormalLaw::linear ? impact : std::min(rayleigh_time(m, radius), impact);
}

double step_share(double fraction) {
    return std::min(4 * fraction, 0.95);
}

}  // namespace grainsweep::dem
