// Clumps: rigid bodies of spheres, and their motion.
//
//     M V' = sum F_s + M g        L' = sum (x_s - X) x F_s + T_s        w = I^-1 L
//
// F_s and T_s: contact force on a member sphere and its torque about the sphere's own centre. A member moves with V + w
// x (x_s - X) and spins with w. Contacts, histories and laws are those of spheres; members of one body never touch.
//
// Scheme: half a kick of V and L, drift of X, a step of the orientation by Richardson's extrapolation, forces at
// half-step velocities, half a kick. It is of second order and keeps L of a free body exactly. The
// order of operations is that of LIGGGHTS 3.8.
#pragma once

#include "solver/geometry/quaternion.hpp"
#include "solver/geometry/vector.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace grainsweep::dem {

using geometry::Quaternion;
using geometry::Vec3;

/// Mass by which contacts of a clump are damped. contact: (1/m + (r x n) I^-1 (r x n))^-1, the mass that an impact
/// there feels, so that every single contact has the coefficient of restitution. body: m, as in LIGGGHTS; only an
/// impact through the centre has the coefficient then.
enum class DampingMass { contact, body };

/// Shape of clumps, at scale 1, in the frame of its centre of mass and axes of inertia.
struct BodyShape {
    struct Member {
        Vec3 place{};       ///< m
        double radius = 0;  ///< m
    };
    std::vector<Member> members;
    double mass = 0;  ///< kg; grows with the cube of the scale
    Vec3 inertia{};   ///< principal moments, kg m2; grow with its fifth power
    DampingMass damping = DampingMass::contact;
};

/// Clump at the start, or one that is added. Its members are consecutive spheres of one kind, in the order of the
/// shape; the engine sets their radii, places and velocities.
struct Body {
    std::size_t shape = 0;  ///< of Setup::shapes
    double scale = 1;
    std::size_t first = 0;  ///< place of its first member in the list of spheres
    Vec3 position{};        ///< of the centre of mass, m
    Quaternion orientation{1, 0, 0, 0};
    Vec3 velocity{};          ///< m/s
    Vec3 angular_velocity{};  ///< rad/s
};

/// Clump that is present.
struct BodyState {
    std::int32_t first = 0;     ///< id of its first member; the others follow
    std::uint32_t members = 0;  ///< number of them
    std::uint32_t shape = 0;    ///< of Setup::shapes
    double scale = 1;
    Vec3 position{};
    Quaternion orientation{1, 0, 0, 0};
    Vec3 velocity{};          ///< at the full step
    Vec3 angular_velocity{};  ///< likewise
    Vec3 angular_momentum{};  ///< about the centre, kg m2/s
    double mass = 0;          ///< kg
    Vec3 inertia{};           ///< kg m2
};

[[nodiscard]] inline double mass_of(const BodyShape& shape, double scale) {
    return scale * scale * scale * shape.mass;
}
[[nodiscard]] inline Vec3 inertia_of(const BodyShape& shape, double scale) {
    using namespace geometry;
    const double square = scale * scale;
    return (square * square * scale) * shape.inertia;
}
/// Returns the largest distance of a point of the shape from its centre of mass, at scale 1, m.
[[nodiscard]] double reach_of(const BodyShape& shape);

/// Axes of inertia of a body in space.
using Axes = std::array<Vec3, 3>;
[[nodiscard]] inline Axes axes_of(const Quaternion& q) {
    const auto rows = geometry::rows_of(q);
    Axes axes{};
    for (std::size_t k = 0; k < 3; ++k) axes[k] = {rows[0][k], rows[1][k], rows[2][k]};
    return axes;
}
/// Returns a vector of the body's frame in space.
[[nodiscard]] inline Vec3 in_space(const Axes& axes, const Vec3& a) {
    using namespace geometry;
    return a[0] * axes[0] + a[1] * axes[1] + a[2] * axes[2];
}
/// Returns the angular velocity that belongs to an angular momentum; `inverse`: of the principal moments, 1/(kg m2).
[[nodiscard]] inline Vec3 spin_of(const Vec3& momentum, const Axes& axes, const Vec3& inverse) {
    using namespace geometry;
    return in_space(axes, {dot(axes[0], momentum) * inverse[0], dot(axes[1], momentum) * inverse[1],
                           dot(axes[2], momentum) * inverse[2]});
}
[[nodiscard]] inline Vec3 momentum_of(const Vec3& spin, const Axes& axes, const Vec3& inertia) {
    return spin_of(spin, axes, inertia);
}
/// Returns what a force along n at a point adds to the inverse mass there; `arm`: lever x n.
[[nodiscard]] inline double added_inverse_mass(const Vec3& arm, const Axes& axes, const Vec3& inverse) {
    using namespace geometry;
    const double a = dot(axes[0], arm), b = dot(axes[1], arm), c = dot(axes[2], arm);
    return a * a * inverse[0] + b * b * inverse[1] + c * c * inverse[2];
}
[[nodiscard]] inline Vec3 inverse_of(const Vec3& moments) {
    return {1 / moments[0], 1 / moments[1], 1 / moments[2]};
}

/// Advances the orientation by `span` s at a constant angular momentum, by one extrapolated step. Returns the angular
/// velocity of the middle of the step, which forces at its end see. `inverse`: of the principal moments, 1/(kg m2).
[[nodiscard]] inline Vec3 turn(Quaternion& q, const Vec3& momentum, const Vec3& inverse, double span) {
    using namespace geometry;
    // q + part w q, of unit length
    const auto advanced = [](const Quaternion& from, const Vec3& spin, double part) {
        const Quaternion rate = product({0, spin[0], spin[1], spin[2]}, from);
        return normalised(
            {from[0] + part * rate[0], from[1] + part * rate[1], from[2] + part * rate[2], from[3] + part * rate[3]});
    };
    const Vec3 before = spin_of(momentum, axes_of(q), inverse);
    const Quaternion whole = advanced(q, before, span / 2), middle = advanced(q, before, span / 4);
    const Vec3 spin = spin_of(momentum, axes_of(middle), inverse);
    const Quaternion halves = advanced(middle, spin, span / 4);
    q = normalised(
        {2 * halves[0] - whole[0], 2 * halves[1] - whole[1], 2 * halves[2] - whole[2], 2 * halves[3] - whole[3]});
    return spin;
}

}  // namespace grainsweep::dem
