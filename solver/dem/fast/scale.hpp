// Conversion between SI and the engine's units, and the constants of the contact laws in these units.
#pragma once

#include "solver/dem/fast/layout.hpp"
#include "solver/dem/kinds.hpp"

namespace grainsweep::dem::fast {

/// Units of one case: length is the largest diameter, time the time step, mass the mass of the largest particle.
struct Scale {
    double length = 1, time = 1, mass = 1;
    Vec3 centre{};                 ///< middle of the domain, m
    std::array<double, 3> unit{};  ///< length of one position unit, m

    [[nodiscard]] double speed() const { return length / time; }
    [[nodiscard]] double force() const { return mass * length / (time * time); }
    /// Returns a coordinate in position units, before wrapping to 32 bits.
    [[nodiscard]] double units(double coordinate, std::size_t axis) const {
        return (coordinate - centre[axis]) / unit[axis];
    }
};

[[nodiscard]] Scale make_scale(const Setup& setup);
/// Returns the density of the particle whose mass is Scale::mass, kg/m3.
[[nodiscard]] double reference_density(const Setup& setup);
/// Returns an acceleration, m/s2, as change of velocity per step.
[[nodiscard]] float gravity_in_steps(double acceleration, const Scale& scale);
/// Returns the engine's unit of a quantity, in SI. The unit of moments of inertia about a contact is 7/5 m R^2.
[[nodiscard]] double unit_of(const Dimension& dimension, const Scale& scale);
/// Writes the constants of a combination of laws for a material, in order.
void write_law_constants(std::int32_t combination, const Material& material, const Scale& scale, double* into);
[[nodiscard]] Constants make_constants(const Setup& setup, const Scale& scale, const Needs& needs);
[[nodiscard]] Needs make_needs(const Setup& setup, bool resting = false);

}  // namespace grainsweep::dem::fast
