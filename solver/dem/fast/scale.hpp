// From SI to the engine's units and back, and the constants of the contact law in them.
#pragma once

#include "solver/dem/fast/layout.hpp"
#include "solver/dem/kinds.hpp"

namespace grainsweep::dem::fast {

/// Units of one case: length the largest diameter, time the time step, mass that of the largest particle.
struct Scale {
    double length = 1, time = 1, mass = 1;
    Vec3 centre{};                 ///< middle of the domain, m
    std::array<double, 3> unit{};  ///< length of one position unit, m

    [[nodiscard]] double speed() const { return length / time; }
    /// Position unit count of a coordinate, before wrapping to 32 bits.
    [[nodiscard]] double units(double coordinate, std::size_t axis) const {
        return (coordinate - centre[axis]) / unit[axis];
    }
};

[[nodiscard]] Scale make_scale(const Setup& setup);
/// That of Scale::mass, kg/m3.
[[nodiscard]] double reference_density(const Setup& setup);
/// An acceleration, m/s2, as change of velocity per step.
[[nodiscard]] float gravity_in_steps(double acceleration, const Scale& scale);
/// Of a quantity, in SI: what is 1 inside. Moments of inertia about a contact are counted in 7/5 m R^2 inside.
[[nodiscard]] double unit_of(const Dimension& dimension, const Scale& scale);
/// The constants of a combination of laws for a material, in order.
void write_law_constants(std::int32_t combination, const Material& material, const Scale& scale, double* into);
[[nodiscard]] Constants make_constants(const Setup& setup, const Scale& scale, const Needs& needs);
[[nodiscard]] Needs make_needs(const Setup& setup, bool resting = false);

}  // namespace grainsweep::dem::fast
