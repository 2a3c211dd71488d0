// Motions of a rigid body in closed form: no step adds to another, so that nothing drifts.
//
//     translation   d = v s                                     s = min(max(t, start), end) - start
//     vibration     d = A (sin(2 pi f s + phase) - sin(phase))  the body starts where it is given
//     rotation      by the angle w s, right hand, about an axis through a point
//
// A list is added up: displacements to D, rotations one after the other, and all points of rotations travel with D:
//
//     x = D + T_n(... T_1(X)),   T_k(X) = o_k + R_k (X - o_k)
//
// so that a later rotation carries the axes of those before it (a stirrer on its own shaft, then around the vessel).
// Velocity of the material: v(x) = dD/dt + sum_k w_k x (x - o_k), with axes and points where they are by then.
#pragma once

#include "solver/geometry/vector.hpp"

#include <limits>
#include <span>
#include <string>
#include <variant>

namespace grainsweep::geometry {

struct Translation {
    Vec3 velocity{};                                                  ///< m/s
    double start = 0, end = std::numeric_limits<double>::infinity();  ///< s

    static void fields(auto& m, auto&& visit) { visit(m.velocity), visit(m.start), visit(m.end); }
};

struct Vibration {
    Vec3 amplitude{};                                                 ///< m
    double frequency = 0;                                             ///< Hz
    double phase = 0;                                                 ///< rad
    double start = 0, end = std::numeric_limits<double>::infinity();  ///< s; where it ends, it stays

    static void fields(auto& m, auto&& visit) {
        visit(m.amplitude), visit(m.frequency), visit(m.phase), visit(m.start), visit(m.end);
    }
};

struct Rotation {
    Vec3 point{};                                                     ///< on the axis, m
    Vec3 axis{0, 0, 1};                                               ///< unit
    double speed = 0;                                                 ///< rad/s
    double start = 0, end = std::numeric_limits<double>::infinity();  ///< s

    static void fields(auto& m, auto&& visit) {
        visit(m.point), visit(m.axis), visit(m.speed), visit(m.start), visit(m.end);
    }
};

using Motion = std::variant<Translation, Vibration, Rotation>;

/// Where a body stands: x = R X + shift.
struct Pose {
    bool turned = false;  ///< false: R = 1
    std::array<Vec3, 3> rows{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    Vec3 shift{};

    [[nodiscard]] Vec3 turn(const Vec3& a) const { return {dot(rows[0], a), dot(rows[1], a), dot(rows[2], a)}; }
    [[nodiscard]] Vec3 turn_back(const Vec3& a) const { return a[0] * rows[0] + a[1] * rows[1] + a[2] * rows[2]; }
    [[nodiscard]] Vec3 from_body(const Vec3& x) const { return turned ? turn(x) + shift : x + shift; }
    [[nodiscard]] Vec3 to_body(const Vec3& x) const { return turned ? turn_back(x - shift) : x - shift; }
};

/// How a body moves: v(x) = velocity + spin x (x - pivot).
struct Twist {
    Vec3 velocity{};     ///< m/s
    bool turns = false;  ///< false: no spin
    Vec3 spin{};         ///< rad/s
    Vec3 pivot{};        ///< m; the point of the last rotation, where it is by now

    [[nodiscard]] Vec3 at(const Vec3& x) const { return turns ? velocity + cross(spin, x - pivot) : velocity; }
};

[[nodiscard]] Pose pose_at(std::span<const Motion> motions, double time);
/// A motion counts from its start on, up to its end.
[[nodiscard]] Twist twist_at(std::span<const Motion> motions, double time);
/// Whether it moves anything at any time.
[[nodiscard]] bool is_still(const Motion& motion);
/// What is wrong with it, in one sentence; empty: nothing.
[[nodiscard]] std::string flaw(const Motion& motion);

}  // namespace grainsweep::geometry
