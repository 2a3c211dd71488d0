// Kinematics of one touching pair, the input of contact laws, and their response.
//
// Signs: overlap d > 0, unit normal n from j (or wall) to i, v = v_i - v_j at the contact; the computed
// force acts on i, its reaction on j.
#pragma once

#include "solver/geometry/vector.hpp"

namespace grainsweep::dem {

using geometry::Vec3;

/// What touches particle i. A wall has R* = R and m* = m, whatever its curvature.
enum class Partner { particle, wall };

template <Partner partner>
struct Touch {
    double overlap = 0;           ///< d, m
    double distance = 0;          ///< between centres, or from the centre to the wall, m
    double radius_i = 0;          ///< m
    double radius_j = 0;          ///< m; a wall has none
    double effective_radius = 0;  ///< R*, m
    double reduced_mass = 0;      ///< m*, kg
    double root = 0;              ///< sqrt(R* d), radius of the Hertzian contact, m
    double damping_root = 0;      ///< sqrt(m* sqrt(R* d)): Hertzian damping is proportional to it
    Vec3 normal{};                ///< from j to i
    double normal_velocity = 0;   ///< v . n, negative while approaching, m/s
    Vec3 slip{};                  ///< tangential velocity of i over j at the contact, m/s; only where a law needs spin
    Vec3 turning{};               ///< w_i - w_j, rad/s; only where a law resists rolling
    double rolling_inertia = 0;   ///< 1/(1/I_i + 1/I_j), I = 7/5 m R^2 about the contact, kg m2; likewise
};

/// Sum of the laws applied so far, in their order: Coulomb's limit takes the normal force of those before it.
struct Response {
    double normal = 0;  ///< along n, N; positive repels
    Vec3 tangential{};  ///< N
    Vec3 rolling{};     ///< moment on i besides that of the forces, minus that on j, N m
};

/// 7/5 m R^2: moment of inertia of a sphere about a point of its surface, over m R^2.
inline constexpr double inertia_about_contact = 1.4;

/// Where a law keeps no memory.
struct NoMemory {};

}  // namespace grainsweep::dem
