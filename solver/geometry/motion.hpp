// Motions of a rigid body. Prescribed motions have a closed form, so errors of steps do not add up. Free motions follow
// from the load on the body; their travel and speed are state, which an engine advances with the particles.
//
//     translation   d = v s                                     s = min(max(t, start), end) - start
//     vibration     d = A (sin(2 pi f s + phase) - sin(phase))  so d = 0 at the start
//     convey        d = 0: the surface has the part of the velocity v along itself, and the body stays (a belt)
//     rotation      by the angle w s, right hand, about an axis through a point
//     press         d = way k              m dv/dt = F + load . k, |v| at most `fastest`
//     drive         by `way` about an axis I dw/dt = M + moment of the load about the axis, |w| at most `fastest`
//                                          F and M are constant, or a course: straight lines between values at times;
//                                          a spring and a damper add - k way - c v, or - k way - c w
//     flight        d = way, turned by q   m dv/dt = F + load, dL/dt = M + moment of the load about the centre of mass
//
// A list of motions is combined: displacements are added to D, rotations follow one another, and all points of
// rotations move with D:
//
//     x = D + T_n(... T_1(X)),   T_k(X) = o_k + R_k (X - o_k)
//
// So a later rotation moves the axes of earlier ones (a stirrer on its own shaft, then around the vessel). Velocity of
// the material: v(x) = dD/dt + sum_k w_k x (x - o_k), with the present axes and points. No rotation may follow a drive
// or a flight, so that their axes and centres are the actual ones.
#pragma once

#include "solver/field.hpp"
#include "solver/geometry/vector.hpp"

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace grainsweep::geometry {

struct Translation {
    Vec3 velocity{};                                                  ///< m/s
    double start = 0, end = std::numeric_limits<double>::infinity();  ///< s
};

/// Conveyance: the surface moves along itself, and the body stays.
struct Conveyance {
    Vec3 velocity{};                                                  ///< m/s, along the surface
    double start = 0, end = std::numeric_limits<double>::infinity();  ///< s
};

struct Vibration {
    Vec3 amplitude{};                                                 ///< m
    double frequency = 0;                                             ///< Hz
    double phase = 0;                                                 ///< rad
    double start = 0, end = std::numeric_limits<double>::infinity();  ///< s; after the end the body stays
};

struct Rotation {
    Vec3 point{};                                                     ///< on the axis, m
    Vec3 axis{0, 0, 1};                                               ///< unit
    double speed = 0;                                                 ///< rad/s
    double start = 0, end = std::numeric_limits<double>::infinity();  ///< s
};

/// Force or moment of a course at a time.
struct LoadAt {
    double time = 0;   ///< s since the motion starts; rising
    double value = 0;  ///< N or N m
};
/// Course of a load: straight lines between its values; the first and the last one hold before and after. Null: the
/// load is constant. Shared, because walls copy their motions in every step.
using LoadCourse = std::shared_ptr<const std::vector<LoadAt>>;
/// Writes (const object) or reads a course with visit(number).
void visit_course(const LoadCourse& course, auto&& visit) {
    visit(static_cast<std::uint64_t>(course ? course->size() : 0));
    if (course)
        for (const LoadAt& load : *course) visit(load);
}
void visit_course(LoadCourse& course, auto&& visit) {
    std::uint64_t size = 0;
    visit(size);
    std::vector<LoadAt> loads;
    for (LoadAt one; loads.size() < size; loads.push_back(one)) visit(one);
    course = loads.empty() ? nullptr : std::make_shared<const std::vector<LoadAt>>(std::move(loads));
}

/// Press: a force moves the body along one direction between `start` and `end`; at other times the body is held.
struct Press {
    Vec3 along{0, 0, -1};                                             ///< unit
    double force = 0;                                                 ///< N, along
    double mass = 1;                                                  ///< kg
    double fastest = 0;                                               ///< m/s
    double start = 0, end = std::numeric_limits<double>::infinity();  ///< s
    double number = 0;                                                ///< unique among free motions of the body
    double way = 0, speed = 0;                                        ///< m, m/s
    LoadCourse course{};                                              ///< of the force, instead of `force`
    double stiffness = 0, damping = 0;                                ///< of a spring and a damper, N/m, N s/m

    static void fields(auto& m, auto&& visit) {
        visit(m.along), visit(m.force), visit(m.mass), visit(m.fastest), visit(m.start), visit(m.end), visit(m.number);
        visit(m.way), visit(m.speed), visit_course(m.course, visit), visit(m.stiffness), visit(m.damping);
    }
};

/// Drive: a moment rotates the body about an axis.
struct Drive {
    Vec3 point{};                                                     ///< on the axis, m
    Vec3 axis{0, 0, 1};                                               ///< unit
    double moment = 0;                                                ///< N m, right hand
    double inertia = 1;                                               ///< kg m2, about the axis
    double fastest = 0;                                               ///< rad/s
    double start = 0, end = std::numeric_limits<double>::infinity();  ///< s
    double number = 0;                                                ///< unique among free motions of the body
    double way = 0, speed = 0;                                        ///< rad, rad/s
    LoadCourse course{};                                              ///< of the moment, instead of `moment`
    double stiffness = 0, damping = 0;                                ///< of a spring and a damper, N m/rad, N m s/rad

    static void fields(auto& m, auto&& visit) {
        visit(m.point), visit(m.axis), visit(m.moment), visit(m.inertia), visit(m.fastest), visit(m.start);
        visit(m.end), visit(m.number), visit(m.way), visit(m.speed), visit_course(m.course, visit);
        visit(m.stiffness), visit(m.damping);
    }
};

/// Flight: the body rotates about its centre of mass and moves along the free axes, between `start` and `end`; at other
/// times it is held.
struct Flight {
    Vec3 centre{};                                                    ///< centre of mass in the original position, m
    double mass = 1;                                                  ///< kg
    std::array<Vec3, 3> axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};      ///< principal axes in the original position; unit
    Vec3 inertia{1, 1, 1};                                            ///< about them, kg m2
    Vec3 freedom{1, 1, 1};                                            ///< 0: its centre is held along this axis
    Vec3 force{}, moment{};                                           ///< N, with the weight; N m
    double fastest = 0;                                               ///< m/s, of the centre
    double fastest_turn = 0;                                          ///< rad/s
    double start = 0, end = std::numeric_limits<double>::infinity();  ///< s
    double number = 0;                                                ///< unique among free motions of the body
    Vec3 way{}, velocity{};                                           ///< of the centre, m, m/s
    std::array<double, 4> turned{1, 0, 0, 0};                         ///< unit quaternion
    Vec3 angular_momentum{};                                          ///< about the centre, kg m2/s
};

using Motion = std::variant<Translation, Vibration, Rotation, Press, Drive, Flight, Conveyance>;
/// Returns the alternatives of a Motion with the fields that a file sets. Centre, inertia and held axes of a flight
/// have no place in it: the reader derives them from the shape.
[[nodiscard]] std::span<const Type> motion_types();

/// Returns whether an engine advances the motion: Press, Drive and Flight.
[[nodiscard]] bool is_free(const Motion& motion);
/// Returns whether the motion rotates the body: Rotation, Drive and Flight.
[[nodiscard]] bool turns(const Motion& motion);
/// Returns the largest absolute value of a load: constant, or of its course.
[[nodiscard]] double largest_load(double constant, const LoadCourse& course);
/// Returns the longest time step that the spring and the damper of a motion allow, s; infinite without them. With
/// dt^2 k/m + 2 dt c/m = 0.1 they take 0.1 of the 4 at which explicit stepping is unstable (solver/dem/network.hpp).
[[nodiscard]] double longest_step(const Motion& motion);
/// Returns the angular velocity of a flight, rad/s.
[[nodiscard]] Vec3 spin_of(const Flight& flight);

/// Booked changes of the kinetic energy of the free motions of a body, J. Their sum is kinetic_energy() to rounding for
/// any time step: a kick changes m v^2/2 by its force times the mean of the speeds before and after it.
struct BodyEnergy {
    double start = 0;     ///< kinetic energy when the walls were set
    double contacts = 0;  ///< work of the load
    double own = 0;       ///< work of what the motions state themselves: force, moment, weight, spring, damper
    double bounds = 0;    ///< work of limits of the speed, of holding the body, and of a change of its motions
    double turning = 0;   ///< error of the integrator: a free turn keeps the energy to second order in the time step

    [[nodiscard]] double sum() const { return start + contacts + own + bounds + turning; }
};

/// Pose of a body: x = R X + shift.
struct Pose {
    bool turned = false;  ///< false: R = 1
    std::array<Vec3, 3> rows{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    Vec3 shift{};

    [[nodiscard]] Vec3 turn(const Vec3& a) const { return {dot(rows[0], a), dot(rows[1], a), dot(rows[2], a)}; }
    [[nodiscard]] Vec3 turn_back(const Vec3& a) const { return a[0] * rows[0] + a[1] * rows[1] + a[2] * rows[2]; }
    [[nodiscard]] Vec3 from_body(const Vec3& x) const { return turned ? turn(x) + shift : x + shift; }
    [[nodiscard]] Vec3 to_body(const Vec3& x) const { return turned ? turn_back(x - shift) : x - shift; }
};

/// Velocity field of a body: v(x) = velocity + spin x (x - pivot). Where its normal is n the surface has besides the
/// part of another velocity along itself: surface - (surface . n) n.
struct Twist {
    Vec3 velocity{};       ///< m/s
    bool turns = false;    ///< false: no spin
    Vec3 spin{};           ///< rad/s
    Vec3 pivot{};          ///< m; present point of the last rotation
    bool conveys = false;  ///< false: no velocity of the surface
    Vec3 surface{};        ///< m/s

    [[nodiscard]] Vec3 at(const Vec3& x) const { return turns ? velocity + cross(spin, x - pivot) : velocity; }
    [[nodiscard]] Vec3 at(const Vec3& x, const Vec3& normal) const {
        return conveys ? at(x) + surface - dot(surface, normal) * normal : at(x);
    }
};

[[nodiscard]] Pose pose_at(std::span<const Motion> motions, double time);
/// Returns the velocity at a time; each motion acts from its start until before its end.
[[nodiscard]] Twist twist_at(std::span<const Motion> motions, double time);
/// Returns the kinetic energy of the free motions, J.
[[nodiscard]] double kinetic_energy(std::span<const Motion> motions);
/// Updates the speeds of free motions after `span` under a load: force on the body, and its moment about a point, at
/// `time`. Other motions do not change. A motion that is held at this time has speed 0. Adds the changes to `energy`.
void kick(std::span<Motion> motions, const Vec3& force, const Vec3& moment, const Vec3& about, double time, double span,
          BodyEnergy& energy);
/// Updates the travel of a free motion after `span`. Adds the change to `energy`.
void drift(Motion& motion, double span, BodyEnergy& energy);
/// Copies travel and speed from the free motion of the same kind and number.
void take_state(Motion& motion, std::span<const Motion> from);
/// Returns whether the motion never moves the body.
[[nodiscard]] bool is_still(const Motion& motion);
/// Returns the error of a motion, in one sentence; empty: none.
[[nodiscard]] std::string flaw(const Motion& motion);
/// Returns the error of a combination of motions.
[[nodiscard]] std::string flaw(std::span<const Motion> motions);

}  // namespace grainsweep::geometry
