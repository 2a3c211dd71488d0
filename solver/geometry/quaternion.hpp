// Unit quaternions: orientations of rigid bodies.
#pragma once

#include "solver/geometry/vector.hpp"

#include <array>
#include <cmath>

namespace grainsweep::geometry {

/// Real part first. A unit quaternion turns vectors from the frame of a body into space.
using Quaternion = std::array<double, 4>;

/// Returns the rows of the matrix that turns vectors of the body's frame into space.
[[nodiscard]] inline std::array<Vec3, 3> rows_of(const Quaternion& q) {
    const auto [w, x, y, z] = q;
    return {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
             {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
             {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
}

[[nodiscard]] inline Quaternion product(const Quaternion& a, const Quaternion& b) {
    return {
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3], a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1], a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

[[nodiscard]] inline Quaternion conjugate(const Quaternion& q) {
    return {q[0], -q[1], -q[2], -q[3]};
}

[[nodiscard]] inline double magnitude(const Quaternion& q) {
    return std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
}

/// Returns the quaternion divided by its magnitude, which must not be 0.
[[nodiscard]] inline Quaternion normalised(const Quaternion& q) {
    const double inverse = 1 / magnitude(q);
    return {inverse * q[0], inverse * q[1], inverse * q[2], inverse * q[3]};
}

/// Returns a vector of the body's frame in space.
[[nodiscard]] inline Vec3 turned(const Quaternion& q, const Vec3& a) {
    const auto rows = rows_of(q);
    return {dot(rows[0], a), dot(rows[1], a), dot(rows[2], a)};
}

/// Returns the orientation of a frame whose axes, orthogonal unit vectors of a right-handed system, are these.
[[nodiscard]] Quaternion orientation_of(const std::array<Vec3, 3>& axes);
/// Returns an orientation of a uniform distribution, from three numbers in [0, 1) (Shoemake 1992, Graphics Gems III,
/// 124).
[[nodiscard]] Quaternion orientation_at(double u1, double u2, double u3);

}  // namespace grainsweep::geometry
