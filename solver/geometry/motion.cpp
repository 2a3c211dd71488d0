#include "solver/geometry/motion.hpp"

#include "solver/geometry/lines.hpp"
#include "solver/geometry/quaternion.hpp"

#include <algorithm>
#include <functional>
#include <numbers>
#include <optional>

namespace grainsweep::geometry {
namespace {

constexpr std::array rotation_fields = {
    needed(fields::direction<&Rotation::axis>("axis", "direction")),
    fields::vector<&Rotation::point>("through", "m", "a point on the axis before all motions; it moves with the wall"),
    needed(fields::quantity<&Rotation::speed>("speed", "rad/s", "right hand")),
};
constexpr std::array translation_fields = {needed(fields::vector<&Translation::velocity>("velocity", "m/s", ""))};
constexpr std::array conveyance_fields = {needed(
    fields::vector<&Conveyance::velocity>("velocity", "m/s", "its part along the surface counts at each place"))};
constexpr std::array vibration_fields = {
    needed(fields::vector<&Vibration::amplitude>("amplitude", "m", "")),
    needed(fields::quantity<&Vibration::frequency>("frequency", "Hz", "", no_negative_number)),
    fields::quantity<&Vibration::phase>("phase", "rad", ""),
};
constexpr Field course_field(std::string_view name, std::string_view meaning) {
    return {name, Field::Kind::array, meaning};
}
constexpr Field course_times =
    course_field("times", "rising times since the motion starts, s; straight lines between, the ends hold");
/// Returns the row of a load, which a reader takes with its course.
constexpr Field course_load(std::string_view name, std::string_view unit, std::string_view meaning) {
    return {name, Field::Kind::quantity, meaning, {}, {}, {}, false, unit};
}
constexpr Field course_every{
    "every", Field::Kind::quantity, "with an expression of t: time from value to value", {}, {}, {}, false, "s"};
constexpr Field course_until{
    "until", Field::Kind::quantity, "with an expression of t: the last time", {}, {}, {}, false, "s"};
constexpr std::array press_fields = {
    needed(
        fields::direction<&Press::along>("along", "direction of the force, the only one in which the wall can move")),
    course_load("force", "N",
                "on the wall, its weight included; or an expression of t, the time since the motion starts"),
    course_field("forces", "or the forces at \"times\", N"),
    course_times,
    course_every,
    course_until,
    needed(fields::quantity<&Press::mass>("mass", "kg", "of the wall", positive_number)),
    needed(fields::quantity<&Press::fastest>("speed_at_most", "m/s",
                                             "it never moves faster; the time step follows from it", positive_number)),
    fields::quantity<&Press::stiffness>(
        "stiffness", "N/m", "of a spring that pulls the wall back to where the motion began", no_negative_number),
    fields::quantity<&Press::damping>("damping", "N s/m", "of a damper of its speed", no_negative_number),
};
constexpr std::array drive_fields = {
    needed(fields::direction<&Drive::axis>("axis", "direction")),
    fields::vector<&Drive::point>("through", "m", "a point on the axis before all motions; it moves with the wall"),
    course_load("torque", "N m",
                "that acts on the wall, right hand; or an expression of t, the time since the motion starts"),
    course_field("torques", "or the torques at \"times\", N m"),
    course_times,
    course_every,
    course_until,
    needed(fields::quantity<&Drive::inertia>("inertia", "kg m2", "moment of inertia of the wall about the axis",
                                             positive_number)),
    needed(fields::quantity<&Drive::fastest>("speed_at_most", "rad/s",
                                             "it never turns faster; the time step follows from it", positive_number)),
    fields::quantity<&Drive::stiffness>(
        "stiffness", "N m/rad", "of a spring that turns the wall back to where the motion began", no_negative_number),
    fields::quantity<&Drive::damping>("damping", "N m s/rad", "of a damper of its speed", no_negative_number),
};
constexpr std::array flight_fields = {
    needed(fields::quantity<&Flight::mass>("mass", "kg", "of the wall; its weight acts on it", positive_number)),
    Field{"centre", Field::Kind::vector, "of mass; default: of an evenly filled mesh", {}, {}, {}, false, "m"},
    Field{"inertia",
          Field::Kind::vector,
          "moments of inertia about the centre, along x, y and z; default: of an evenly filled mesh",
          {},
          {},
          {},
          false,
          "kg m2"},
    Field{"held", Field::Kind::vector, "along x, y and z a value: not 0 holds its centre along this axis", "[0, 0, 0]"},
    fields::vector<&Flight::force>("force", "N", "that acts on the centre besides the weight"),
    fields::vector<&Flight::moment>("torque", "N m", "that acts on the wall"),
    needed(fields::quantity<&Flight::fastest>(
        "speed_at_most", "m/s",
        "its centre never moves faster, nor its farthest corner by turning; the time step follows from it",
        positive_number)),
};
constexpr std::array motion_rows = {
    fields::alternative<Motion, Rotation>("rotate", "about an axis", rotation_fields),
    fields::alternative<Motion, Translation>("shift", "at a velocity", translation_fields),
    fields::alternative<Motion, Conveyance>("convey", "the surface moves, and the wall stays: a belt",
                                            conveyance_fields),
    fields::alternative<Motion, Vibration>("vibrate", "to and fro", vibration_fields),
    fields::alternative<Motion, Press>("press", "a force acts, and the powder resists", press_fields),
    fields::alternative<Motion, Drive>("drive", "a torque acts, and the powder resists", drive_fields),
    fields::alternative<Motion, Flight>(
        "free", "its weight acts, and the powder resists: it falls, floats and turns as it must", flight_fields),
};

double elapsed(const auto& motion, double t) {
    return std::min(std::max(t, motion.start), motion.end) - motion.start;
}
bool runs(const auto& motion, double t) {
    return t >= motion.start && t < motion.end;
}
double pulsation(const Vibration& v) {
    return 2 * std::numbers::pi * v.frequency;
}

/// Of motions that do not shift the wall.
Vec3 displacement(const auto&, double) {
    return {};
}
Vec3 displacement(const Translation& m, double t) {
    return elapsed(m, t) * m.velocity;
}
Vec3 displacement(const Vibration& m, double t) {
    const double sine = std::sin(pulsation(m) * elapsed(m, t) + m.phase) - std::sin(m.phase);
    return sine * m.amplitude;
}
Vec3 displacement(const Press& m, double) {
    return m.way * m.along;
}
Vec3 displacement(const Flight& m, double) {
    return m.way;
}

Vec3 velocity(const auto& m, double) {
    if constexpr (requires { m.velocity; }) return m.velocity;
    return {};
}
Vec3 velocity(const Vibration& m, double t) {
    const double cosine = std::cos(pulsation(m) * elapsed(m, t) + m.phase);
    return cosine * (pulsation(m) * m.amplitude);
}
Vec3 velocity(const Press& m, double) {
    return m.speed * m.along;
}

Vec3 displacement_of(std::span<const Motion> motions, double t) {
    Vec3 total{};
    for (const Motion& motion : motions) total += std::visit([t](const auto& m) { return displacement(m, t); }, motion);
    return total;
}

/// Rodrigues: R a = cos a + sin (k x a) + (1 - cos) (k . a) k, column by column.
std::array<Vec3, 3> rotation_rows(const Vec3& k, double angle) {
    const double c = std::cos(angle), s = std::sin(angle);
    const double u = 1 - c;
    return {{{c + u * k[0] * k[0], u * k[0] * k[1] - s * k[2], u * k[0] * k[2] + s * k[1]},
             {u * k[1] * k[0] + s * k[2], c + u * k[1] * k[1], u * k[1] * k[2] - s * k[0]},
             {u * k[2] * k[0] - s * k[1], u * k[2] * k[1] + s * k[0], c + u * k[2] * k[2]}}};
}

Pose turned_pose(const Flight& m) {
    return {.turned = true, .rows = rows_of(m.turned), .shift = {}};
}

/// Angular momentum along an axis of inertia, which the body has turned.
double momentum_along(const Flight& m, const Pose& pose, std::size_t axis) {
    return dot(pose.turn(m.axes[axis]), m.angular_momentum);
}

/// Rotates a body without moments for `span`, by free rotations about one axis of inertia after the other. It conserves
/// angular momentum, is of second order, and is reversible (Dullweber, Leimkuhler & McLachlan 1997, doi
/// 10.1063/1.474310).
void turn_freely(Flight& m, double span) {
    constexpr std::array<std::size_t, 5> order = {0, 1, 2, 1, 0};
    constexpr std::array<double, 5> shares = {0.5, 0.5, 1, 0.5, 0.5};
    for (std::size_t k = 0; k < order.size(); ++k) {
        const std::size_t axis = order[k];
        const double half = shares[k] * span * momentum_along(m, turned_pose(m), axis) / m.inertia[axis] / 2;
        const double s = std::sin(half);
        m.turned = product(m.turned, {std::cos(half), s * m.axes[axis][0], s * m.axes[axis][1], s * m.axes[axis][2]});
    }
    double square = 0;
    for (const double part : m.turned) square += part * part;
    for (double& part : m.turned) part /= std::sqrt(square);
}

/// A turn about a point, prescribed or free, as it is at a time.
struct Turn {
    Vec3 point{}, spin{};
    std::array<Vec3, 3> rows{};
};
std::optional<Turn> turn_of(const Motion& motion, double t) {
    if (const auto* m = std::get_if<Rotation>(&motion))
        return Turn{m->point, (runs(*m, t) ? m->speed : 0) * m->axis,
                    rotation_rows(m->axis, m->speed * elapsed(*m, t))};
    if (const auto* m = std::get_if<Drive>(&motion))
        return Turn{m->point, m->speed * m->axis, rotation_rows(m->axis, m->way)};
    if (const auto* m = std::get_if<Flight>(&motion)) return Turn{m->centre, spin_of(*m), rows_of(m->turned)};
    return std::nullopt;
}

/// Returns the pose after a rotation about a point.
Pose rotated(const Pose& pose, const std::array<Vec3, 3>& rows, const Vec3& point) {
    const Pose rotation{.turned = true, .rows = rows, .shift = {}};
    Pose result{.turned = true, .rows = {}, .shift = {}};
    for (std::size_t column = 0; column < 3; ++column) {
        const Vec3 a = rotation.turn({pose.rows[0][column], pose.rows[1][column], pose.rows[2][column]});
        for (std::size_t row = 0; row < 3; ++row) result.rows[row][column] = a[row];
    }
    result.shift = point + rotation.turn(pose.shift - point);
    return result;
}

}  // namespace

std::span<const Type> motion_types() {
    return motion_rows;
}

Pose pose_at(std::span<const Motion> motions, double time) {
    Pose pose;
    for (const Motion& motion : motions)
        if (const auto turn = turn_of(motion, time)) pose = rotated(pose, turn->rows, turn->point);
    pose.shift += displacement_of(motions, time);
    return pose;
}

Twist twist_at(std::span<const Motion> motions, double time) {
    Twist twist;
    Vec3 rate{};
    for (const Motion& motion : motions) {
        if (std::visit([time](const auto& m) { return runs(m, time); }, motion)) {
            const Vec3 adds = std::visit([time](const auto& m) { return velocity(m, time); }, motion);
            const bool conveys = std::holds_alternative<Conveyance>(motion);
            (conveys ? twist.surface : rate) += adds;
            twist.conveys = twist.conveys || conveys;
        }
        const auto turn = turn_of(motion, time);
        if (!turn) continue;
        if (twist.turns) {  // carried along, then seen from the new point
            const Pose carry{.turned = true, .rows = turn->rows, .shift = {}};
            twist.spin = carry.turn(twist.spin);
            const Vec3 pivot = turn->point + carry.turn(twist.pivot - turn->point);
            twist.velocity = carry.turn(twist.velocity) + cross(twist.spin, turn->point - pivot);
        }
        if (turn->spin != Vec3{}) twist.spin += turn->spin;
        twist.pivot = turn->point;
        twist.turns = true;
    }
    twist.velocity += rate;
    twist.pivot += displacement_of(motions, time);
    return twist;
}

bool is_free(const Motion& motion) {
    return std::visit(
        [](const auto& m) {
            return requires {
                m.way;
            };
        },
        motion);
}

bool turns(const Motion& motion) {
    return std::holds_alternative<Rotation>(motion) || std::holds_alternative<Drive>(motion) ||
           std::holds_alternative<Flight>(motion);
}

double largest_load(double constant, const LoadCourse& course) {
    if (!course) return std::abs(constant);
    double most = 0;
    for (const LoadAt& load : *course) most = std::max(most, std::abs(load.value));
    return most;
}

double longest_step(const Motion& motion) {
    const auto of = [](const auto& m, double inertia) {
        const double damper = m.damping / inertia;
        return 0.1 / (damper + std::sqrt(damper * damper + 0.1 * m.stiffness / inertia));
    };
    if (const auto* m = std::get_if<Press>(&motion)) return of(*m, m->mass);
    if (const auto* m = std::get_if<Drive>(&motion)) return of(*m, m->inertia);
    return std::numeric_limits<double>::infinity();
}

Vec3 spin_of(const Flight& m) {
    const Pose pose = turned_pose(m);
    Vec3 spin{};
    for (std::size_t k = 0; k < 3; ++k) spin += momentum_along(m, pose, k) / m.inertia[k] * m.axes[k];
    return pose.turn(spin);
}

namespace {

double turning_energy(const Flight& m) {
    return dot(m.angular_momentum, spin_of(m)) / 2;
}

double kinetic_energy_of(const auto&) {
    return 0;
}
double kinetic_energy_of(const Press& m) {
    return m.mass / 2 * m.speed * m.speed;
}
double kinetic_energy_of(const Drive& m) {
    return m.inertia / 2 * m.speed * m.speed;
}
double kinetic_energy_of(const Flight& m) {
    return m.mass / 2 * dot(m.velocity, m.velocity) + turning_energy(m);
}

/// Returns a load at a time since its motion started.
double load_at(double constant, const LoadCourse& course, double time) {
    if (!course) return constant;
    const auto after = std::ranges::upper_bound(*course, time, {}, &LoadAt::time);
    if (after == course->begin()) return course->front().value;
    if (after == course->end()) return course->back().value;
    const LoadAt &a = *(after - 1), &b = *after;
    return a.value + (time - a.time) / (b.time - a.time) * (b.value - a.value);
}

/// Of a press or a drive: `load` and `driving` are forces along its way, or moments about its axis.
void kick_along(auto& m, double inertia, double load, double driving, double time, double span, BodyEnergy& energy) {
    const double before = m.speed, own = driving - m.stiffness * m.way - m.damping * before;
    if (!runs(m, time)) {
        m.speed = 0;
        energy.bounds -= inertia / 2 * before * before;
        return;
    }
    const double after = m.speed + span * ((own + load) / inertia);
    m.speed = std::clamp(after, -m.fastest, m.fastest);
    const double mean = (before + m.speed) / 2;
    energy.contacts += span * load * mean;
    energy.own += span * own * mean;
    energy.bounds += inertia * (m.speed - after) * mean;
}

void kick_flight(Flight& m, const Vec3& force, const Vec3& moment, double time, double span, BodyEnergy& energy) {
    if (!runs(m, time)) {
        energy.bounds -= kinetic_energy_of(m);
        m.velocity = m.angular_momentum = {};
        return;
    }
    const Vec3 velocity = m.velocity, spin = spin_of(m);
    for (std::size_t k = 0; k < 3; ++k) m.velocity[k] += m.freedom[k] * span / m.mass * (m.force[k] + force[k]);
    m.angular_momentum += span * (m.moment + moment);
    const Vec3 free_velocity = m.velocity, free_momentum = m.angular_momentum;
    if (const double speed = norm(m.velocity); speed > m.fastest) m.velocity = m.fastest / speed * m.velocity;
    Vec3 spin_after = spin_of(m);
    if (const double turn = norm(spin_after); turn > m.fastest_turn) {
        m.angular_momentum = m.fastest_turn / turn * m.angular_momentum;
        spin_after = spin_of(m);
    }
    const Vec3 mean = 0.5 * (velocity + m.velocity), mean_spin = 0.5 * (spin + spin_after);
    for (std::size_t k = 0; k < 3; ++k) {
        energy.contacts += span * m.freedom[k] * force[k] * mean[k];
        energy.own += span * m.freedom[k] * m.force[k] * mean[k];
    }
    energy.contacts += span * dot(moment, mean_spin);
    energy.own += span * dot(m.moment, mean_spin);
    energy.bounds +=
        m.mass * dot(m.velocity - free_velocity, mean) + dot(m.angular_momentum - free_momentum, mean_spin);
}

}  // namespace

double kinetic_energy(std::span<const Motion> motions) {
    double energy = 0;
    for (const Motion& motion : motions)
        energy += std::visit([](const auto& m) { return kinetic_energy_of(m); }, motion);
    return energy;
}

void kick(std::span<Motion> motions, const Vec3& force, const Vec3& moment, const Vec3& about, double time, double span,
          BodyEnergy& energy) {
    const Vec3 shift = displacement_of(motions, time);
    const auto moment_about = [&](const Vec3& point) { return moment + cross(about - shift - point, force); };
    for (Motion& motion : motions) {
        if (auto* m = std::get_if<Press>(&motion))
            kick_along(*m, m->mass, dot(force, m->along), load_at(m->force, m->course, time - m->start), time, span,
                       energy);
        if (auto* m = std::get_if<Drive>(&motion))
            kick_along(*m, m->inertia, dot(moment_about(m->point), m->axis),
                       load_at(m->moment, m->course, time - m->start), time, span, energy);
        if (auto* m = std::get_if<Flight>(&motion)) kick_flight(*m, force, moment_about(m->centre), time, span, energy);
    }
}

void drift(Motion& motion, double span, BodyEnergy& energy) {
    if (auto* m = std::get_if<Press>(&motion)) m->way += span * m->speed;
    if (auto* m = std::get_if<Drive>(&motion)) m->way += span * m->speed;
    if (auto* m = std::get_if<Flight>(&motion)) {
        m->way += span * m->velocity;
        if (m->angular_momentum == Vec3{}) return;
        const double before = turning_energy(*m);
        turn_freely(*m, span);
        energy.turning += turning_energy(*m) - before;
    }
}

void take_state(Motion& motion, std::span<const Motion> from) {
    const auto take = [](auto& m, const auto& other) {
        m.way = other.way;
        if constexpr (requires { m.speed; })
            m.speed = other.speed;
        else
            m.velocity = other.velocity, m.turned = other.turned, m.angular_momentum = other.angular_momentum;
    };
    for (const Motion& before : from)
        if (before.index() == motion.index())
            std::visit(
                [&]<class M>(M& m) {
                    if constexpr (requires { m.way; })
                        if (const M& other = std::get<M>(before); other.number == m.number) take(m, other);
                },
                motion);
}

bool is_still(const Motion& motion) {
    if (is_free(motion)) return false;
    if (const auto* m = std::get_if<Translation>(&motion)) return m->velocity == Vec3{};
    if (const auto* m = std::get_if<Conveyance>(&motion)) return m->velocity == Vec3{};
    if (const auto* m = std::get_if<Vibration>(&motion)) return m->amplitude == Vec3{} || m->frequency == 0;
    return std::get<Rotation>(motion).speed == 0;
}

namespace {

bool is_positive(double x) {
    return x > 0 && std::isfinite(x);
}

bool is_sound(const LoadCourse& course) {
    if (!course) return true;
    const auto is_finite = [](const LoadAt& load) { return std::isfinite(load.time) && std::isfinite(load.value); };
    return std::ranges::all_of(*course, is_finite) &&
           std::ranges::adjacent_find(*course, std::greater_equal<>(), &LoadAt::time) == course->end();
}

bool has_sound_spring(const auto& m) {
    return m.stiffness >= 0 && m.damping >= 0 && std::isfinite(m.stiffness) && std::isfinite(m.damping);
}

std::string flaw_of(const auto& m) {
    return finite(m.velocity) ? "" : "a motion must be finite";
}
std::string flaw_of(const Vibration& m) {
    return finite(m.amplitude) && std::isfinite(m.frequency) && std::isfinite(m.phase) ? "" : "a motion must be finite";
}
std::string flaw_of(const Rotation& m) {
    if (!(finite(m.point) && finite(m.axis) && std::isfinite(m.speed))) return "a motion must be finite";
    return is_unit(m.axis) ? "" : "the axis of a rotation must have unit length";
}
std::string flaw_of(const Press& m) {
    if (!(finite(m.along) && std::isfinite(m.force) && std::isfinite(m.way) && std::isfinite(m.speed)))
        return "a motion must be finite";
    if (!is_unit(m.along)) return "the direction of a press must have unit length";
    if (!is_positive(m.mass)) return "the mass of a pressed wall must be above 0";
    if (!has_sound_spring(m)) return "the spring of a pressed wall must be finite and not negative";
    if (!is_sound(m.course)) return "the times of a load must rise, and its values be finite";
    return is_positive(m.fastest) ? "" : "the speed of a pressed wall must have a bound above 0";
}
std::string flaw_of(const Drive& m) {
    if (!(finite(m.point) && finite(m.axis) && std::isfinite(m.moment) && std::isfinite(m.way) &&
          std::isfinite(m.speed)))
        return "a motion must be finite";
    if (!is_unit(m.axis)) return "the axis of a drive must have unit length";
    if (!is_positive(m.inertia)) return "the inertia of a driven wall must be above 0";
    if (!has_sound_spring(m)) return "the spring of a driven wall must be finite and not negative";
    if (!is_sound(m.course)) return "the times of a load must rise, and its values be finite";
    return is_positive(m.fastest) ? "" : "the speed of a driven wall must have a bound above 0";
}
std::string flaw_of(const Flight& m) {
    double square = 0;
    for (const double part : m.turned) square += part * part;
    if (!(finite(m.centre) && finite(m.force) && finite(m.moment) && finite(m.way) && finite(m.velocity) &&
          finite(m.angular_momentum)))
        return "a motion must be finite";
    if (!(std::abs(square - 1) < 1e-9 && std::ranges::all_of(m.axes, is_unit)))
        return "the axes of a free body must have unit length";
    if (!(is_positive(m.mass) && std::ranges::all_of(m.inertia, is_positive)))
        return "mass and moments of inertia of a free body must be above 0";
    return is_positive(m.fastest) && is_positive(m.fastest_turn) ? ""
                                                                 : "the speed of a free body must have a bound above 0";
}

}  // namespace

std::string flaw(const Motion& motion) {
    const bool ordered = std::visit([](const auto& m) { return std::isfinite(m.start) && m.end >= m.start; }, motion);
    if (!ordered) return "a motion must start at a finite time and not end before it";
    return std::visit([](const auto& m) { return flaw_of(m); }, motion);
}

std::string flaw(std::span<const Motion> motions) {
    bool free_turn = false;
    for (const Motion& motion : motions) {
        if (free_turn && turns(motion)) return "nothing may turn a wall after a drive, or after it moves freely";
        free_turn = free_turn || (turns(motion) && is_free(motion));
    }
    return {};
}

}  // namespace grainsweep::geometry
