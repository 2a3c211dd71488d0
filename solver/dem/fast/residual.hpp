// Access to the rounding errors of a particle's position and velocity, for code outside the kernels. If radii differ
// they have a column of their own (Field::residuals). If radii are equal they use free members of Record and Force, so
// that a sweep moves a sixth fewer bytes.
#pragma once

#include <cstdint>

#include "solver/dem/fast/layout.hpp"

namespace grainsweep::dem::fast {

inline Residual residual_of(const Field& f, std::int32_t i) {
    if (f.residuals != nullptr) return f.residuals[i];
    const float* rest = f.records[i].rest;
    const Force& force = f.forces[i];
    return {{rest[0], rest[1], rest[2], 0}, {rest[3], force.force[3], force.torque[3], 0}};
}

inline void leave_over(Field& f, std::int32_t i, const Residual& r) {
    if (f.residuals != nullptr) {
        f.residuals[i] = r;
        return;
    }
    float* rest = f.records[i].rest;
    for (int a = 0; a < 3; ++a) rest[a] = r.position[a];
    rest[3] = r.velocity[0];
    f.forces[i].force[3] = r.velocity[1];
    f.forces[i].torque[3] = r.velocity[2];
}

/// Returns a force with zero force and torque, and its other members.
inline Force cleared(const Force& f) {
    Force none{};
    none.force[3] = f.force[3];
    none.torque[3] = f.torque[3];
    return none;
}

/// Sets a spin, and the derived members if radii differ.
inline void set_spin(const Field& f, std::int32_t i, int a, float spin) {
    Record& r = f.records[i];
    r.spin[a] = spin;
    if (f.residuals != nullptr) r.rest[a] = spin * r.radius;
}

}  // namespace grainsweep::dem::fast
