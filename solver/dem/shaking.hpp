// Shaken vessel in its own frame: the displacement D(t) = A sin(w t), w = 2 pi f, becomes a body force.
//
// With leapfrog positions x in the laboratory, u = x - D obeys leapfrog in the vessel with the extra acceleration
//     b_n = -(D_(n+1) - 2 D_n + D_(n-1))/dt^2 = (4/dt^2) sin^2(w dt/2) A sin(w t_n),
// exactly, because a frozen sphere has the velocity (D_(n+1) - D_n)/dt in a step, and contacts depend on differences
// only.
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/geometry/vector.hpp"

#include <cmath>
#include <numbers>

namespace grainsweep::dem {

[[nodiscard]] inline bool is_still(const Shaking& s) {
    return s.frequency == 0 || s.amplitude == Vec3{};
}

/// Returns the displacement of the vessel at time t, m.
[[nodiscard]] inline Vec3 displacement(const Shaking& s, double t) {
    using geometry::operator*;
    return std::sin(2 * std::numbers::pi * s.frequency * t) * s.amplitude;
}

/// Returns the acceleration of free particles in the vessel after `step` time steps of dt, m/s2.
[[nodiscard]] inline Vec3 shaking_acceleration(const Shaking& s, double dt, std::int64_t step) {
    using geometry::operator*;
    const double per_step = 2 * std::sin(std::numbers::pi * s.frequency * dt) / dt;
    return (per_step * per_step) * displacement(s, dt * static_cast<double>(step));
}

/// Returns the largest speed of the vessel, m/s.
[[nodiscard]] inline double fastest(const Shaking& s) {
    return 2 * std::numbers::pi * s.frequency * geometry::norm(s.amplitude);
}

}  // namespace grainsweep::dem
