#include "solver/geometry/motion.hpp"

#include "solver/geometry/lines.hpp"

#include <algorithm>
#include <numbers>
#include <optional>

namespace grainsweep::geometry {
namespace {

double elapsed(const auto& motion, double t) {
    return std::min(std::max(t, motion.start), motion.end) - motion.start;
}
bool runs(const auto& motion, double t) {
    return t >= motion.start && t < motion.end;
}
double pulsation(const Vibration& v) {
    return 2 * std::numbers::pi * v.frequency;
}

Vec3 displacement(const Translation& m, double t) {
    return elapsed(m, t) * m.velocity;
}
Vec3 displacement(const Vibration& m, double t) {
    const double sine = std::sin(pulsation(m) * elapsed(m, t) + m.phase) - std::sin(m.phase);
    return sine * m.amplitude;
}
Vec3 displacement(const Rotation&, double) {
    return {};
}
Vec3 displacement(const Press& m, double) {
    return m.way * m.along;
}
Vec3 displacement(const Drive&, double) {
    return {};
}

Vec3 velocity(const Translation& m, double) {
    return m.velocity;
}
Vec3 velocity(const Vibration& m, double t) {
    const double cosine = std::cos(pulsation(m) * elapsed(m, t) + m.phase);
    return cosine * (pulsation(m) * m.amplitude);
}
Vec3 velocity(const Rotation&, double) {
    return {};
}
Vec3 velocity(const Press& m, double) {
    return m.speed * m.along;
}
Vec3 velocity(const Drive&, double) {
    return {};
}

/// A turn about an axis, prescribed or free, as it is at a time.
struct Turn {
    Vec3 point{}, axis{};
    double angle = 0, speed = 0;
};
std::optional<Turn> turn_of(const Motion& motion, double t) {
    if (const auto* m = std::get_if<Rotation>(&motion))
        return Turn{m->point, m->axis, m->speed * elapsed(*m, t), runs(*m, t) ? m->speed : 0};
    if (const auto* m = std::get_if<Drive>(&motion)) return Turn{m->point, m->axis, m->way, m->speed};
    return std::nullopt;
}

/// Rodrigues: R a = cos a + sin (k x a) + (1 - cos) (k . a) k, column by column.
std::array<Vec3, 3> rotation_rows(const Turn& turn) {
    const double c = std::cos(turn.angle), s = std::sin(turn.angle);
    const Vec3& k = turn.axis;
    const double u = 1 - c;
    return {{{c + u * k[0] * k[0], u * k[0] * k[1] - s * k[2], u * k[0] * k[2] + s * k[1]},
             {u * k[1] * k[0] + s * k[2], c + u * k[1] * k[1], u * k[1] * k[2] - s * k[0]},
             {u * k[2] * k[0] - s * k[1], u * k[2] * k[1] + s * k[0], c + u * k[2] * k[2]}}};
}

/// The pose after turning what stands in `pose` about a point.
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

Pose pose_at(std::span<const Motion> motions, double time) {
    Pose pose;
    Vec3 total{};
    for (const Motion& motion : motions) {
        total += std::visit([time](const auto& m) { return displacement(m, time); }, motion);
        if (const auto m = turn_of(motion, time)) pose = rotated(pose, rotation_rows(*m), m->point);
    }
    pose.shift += total;
    return pose;
}

Twist twist_at(std::span<const Motion> motions, double time) {
    Twist twist;
    Vec3 total{}, rate{};
    for (const Motion& motion : motions) {
        total += std::visit([time](const auto& m) { return displacement(m, time); }, motion);
        if (std::visit([time](const auto& m) { return runs(m, time); }, motion))
            rate += std::visit([time](const auto& m) { return velocity(m, time); }, motion);
        const auto m = turn_of(motion, time);
        if (!m) continue;
        if (twist.turns) {  // carried along, then seen from the new point
            const Pose carry{.turned = true, .rows = rotation_rows(*m), .shift = {}};
            twist.spin = carry.turn(twist.spin);
            const Vec3 pivot = m->point + carry.turn(twist.pivot - m->point);
            twist.velocity = carry.turn(twist.velocity) + cross(twist.spin, m->point - pivot);
        }
        if (m->speed != 0) twist.spin += m->speed * m->axis;
        twist.pivot = m->point;
        twist.turns = true;
    }
    twist.velocity += rate;
    twist.pivot += total;
    return twist;
}

bool is_free(const Motion& motion) {
    return std::holds_alternative<Press>(motion) || std::holds_alternative<Drive>(motion);
}

void kick(Motion& motion, const Vec3& force, const Vec3& moment, const Vec3& about, double time, double span) {
    const auto set = [&](auto& m, double acceleration) {
        m.speed = runs(m, time) ? std::clamp(m.speed + span * acceleration, -m.fastest, m.fastest) : 0;
    };
    if (auto* m = std::get_if<Press>(&motion)) set(*m, (m->force + dot(force, m->along)) / m->mass);
    if (auto* m = std::get_if<Drive>(&motion))
        set(*m, (m->moment + dot(moment + cross(about - m->point, force), m->axis)) / m->inertia);
}

void drift(Motion& motion, double span) {
    if (auto* m = std::get_if<Press>(&motion)) m->way += span * m->speed;
    if (auto* m = std::get_if<Drive>(&motion)) m->way += span * m->speed;
}

void take_state(Motion& motion, std::span<const Motion> from) {
    for (const Motion& before : from)
        if (before.index() == motion.index())
            std::visit(
                [&]<class M>(M& m) {
                    if constexpr (requires { m.way; })
                        if (const M& other = std::get<M>(before); other.number == m.number)
                            m.way = other.way, m.speed = other.speed;
                },
                motion);
}

bool is_still(const Motion& motion) {
    if (is_free(motion)) return false;
    if (const auto* m = std::get_if<Translation>(&motion)) return m->velocity == Vec3{};
    if (const auto* m = std::get_if<Vibration>(&motion)) return m->amplitude == Vec3{} || m->frequency == 0;
    return std::get<Rotation>(motion).speed == 0;
}

std::string flaw(const Motion& motion) {
    const bool ordered = std::visit([](const auto& m) { return std::isfinite(m.start) && m.end >= m.start; }, motion);
    if (!ordered) return "a motion must start at a finite time and not end before it";
    bool sound = true;
    if (const auto* m = std::get_if<Translation>(&motion)) sound = finite(m->velocity);
    if (const auto* m = std::get_if<Vibration>(&motion))
        sound = finite(m->amplitude) && std::isfinite(m->frequency) && std::isfinite(m->phase);
    if (const auto* m = std::get_if<Rotation>(&motion)) {
        sound = finite(m->point) && finite(m->axis) && std::isfinite(m->speed);
        if (sound && !is_unit(m->axis)) return "the axis of a rotation must have unit length";
    }
    if (const auto* m = std::get_if<Press>(&motion)) {
        sound = finite(m->along) && std::isfinite(m->force) && std::isfinite(m->way) && std::isfinite(m->speed);
        if (sound && !is_unit(m->along)) return "the direction of a press must have unit length";
        if (!(m->mass > 0 && std::isfinite(m->mass))) return "the mass of a pressed wall must be above 0";
        if (!(m->fastest > 0 && std::isfinite(m->fastest)))
            return "the speed of a pressed wall must have a bound above 0";
    }
    if (const auto* m = std::get_if<Drive>(&motion)) {
        sound = finite(m->point) && finite(m->axis) && std::isfinite(m->moment) && std::isfinite(m->way) &&
                std::isfinite(m->speed);
        if (sound && !is_unit(m->axis)) return "the axis of a drive must have unit length";
        if (!(m->inertia > 0 && std::isfinite(m->inertia))) return "the inertia of a driven wall must be above 0";
        if (!(m->fastest > 0 && std::isfinite(m->fastest)))
            return "the speed of a driven wall must have a bound above 0";
    }
    return sound ? "" : "a motion must be finite";
}

}  // namespace grainsweep::geometry
