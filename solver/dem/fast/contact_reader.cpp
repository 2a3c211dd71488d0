#include "solver/dem/fast/contact_reader.hpp"

#include <cmath>
#include <limits>

#include "solver/dem/material.hpp"
#include "solver/dem/moving_wall.hpp"

namespace grainsweep::dem::fast {

using namespace geometry;

namespace {

Contact<Hertz, Cohesion<ChosenArea>, Mindlin, Cohesion<ChosenArea>> laws_of(const Material& m) {
    // Friction sees the laws before it; no law advances a spring here, so none needs a time step.
    const bool friction_sees_it = m.friction_limit == FrictionLimit::net;
    const Cohesion<ChosenArea> before{friction_sees_it ? m.cohesion : 0.0, {m.cohesion_area}};
    const Cohesion<ChosenArea> after{friction_sees_it ? 0.0 : m.cohesion, {m.cohesion_area}};
    return {{hertz(m), before, mindlin(m, 0), after}};
}

}  // namespace

ContactReader::ContactReader(const Material& material, const Room& room, const Field& field, const std::int32_t* id,
                             std::span<const Motion> motions, std::int32_t width)
    : room_(room), field_(field), id_(id), motions_(motions), width_(width), laws_(laws_of(material)) {}

double ContactReader::radius(std::int32_t i) const {
    return static_cast<double>(field_.records[i].radius) * room_.scale.length;
}

double ContactReader::mass(std::int32_t i) const {
    const double inverse = static_cast<double>(field_.records[i].inverse_mass);
    return inverse > 0 ? room_.scale.mass / inverse : std::numeric_limits<double>::infinity();
}

/// Completes a touch whose geometry is known and appends what the laws say of it.
template <Partner partner>
void ContactReader::add(Touch<partner>& t, std::int32_t i, std::int32_t second, const Vec3& velocity, const Vec3& turn,
                        Vec3 spring, std::vector<ContactForce>& into) const {
    t.root = std::sqrt(t.effective_radius * t.overlap);
    t.damping_root = std::sqrt(t.root * t.reduced_mass);
    t.normal_velocity = dot(velocity, t.normal);
    t.slip = velocity - t.normal_velocity * t.normal - cross(turn, t.normal);
    const Response r = laws_.respond<false>(t, spring);
    into.push_back({id_[i], second, t.overlap, t.normal, r.normal, r.tangential});
}

void ContactReader::pair(std::int32_t i, std::int32_t j, const Vec3& spring, std::vector<ContactForce>& into) const {
    const Record &a = field_.records[i], &b = field_.records[j];
    Vec3 branch{};
    for (std::size_t axis = 0; axis < 3; ++axis)  // the difference of two positions is that of the nearest images
        branch[axis] = static_cast<std::int32_t>(static_cast<std::uint32_t>(a.position[axis]) -
                                                 static_cast<std::uint32_t>(b.position[axis])) *
                       room_.scale.unit[axis];
    Touch<Partner::particle> t;
    t.radius_i = radius(i);
    t.radius_j = radius(j);
    t.distance = norm(branch);
    t.overlap = t.radius_i + t.radius_j - t.distance;
    if (!(t.overlap > 0) || (!(a.inverse_mass > 0) && !(b.inverse_mass > 0))) return;
    t.normal = (1 / t.distance) * branch;
    t.effective_radius = t.radius_i * t.radius_j / (t.radius_i + t.radius_j);
    t.reduced_mass = 1 / (1 / mass(i) + 1 / mass(j));
    const Motion &of_i = motions_[static_cast<std::size_t>(i)], &of_j = motions_[static_cast<std::size_t>(j)];
    const Vec3 turn = (t.radius_i - t.overlap / 2) * of_i.spin + (t.radius_j - t.overlap / 2) * of_j.spin;
    add(t, i, id_[j], of_i.velocity - of_j.velocity, turn, spring, into);
}

void ContactReader::pairs(std::vector<ContactForce>& into) const {
    std::int64_t stream = 0;  // springs of the pairs whose bit is set, without gaps
    for (std::int32_t k = 0; k < field_.inner_count; ++k) {
        const auto i = static_cast<std::int32_t>(field_.inner_first[k] / places_per_index);
        const auto j = static_cast<std::int32_t>(field_.inner_second[k] / places_per_index);
        Vec3 spring{};
        if ((field_.touching[k / width_] >> (k % width_) & 1) != 0) {
            for (std::size_t axis = 0; axis < 3; ++axis)
                spring[axis] = static_cast<double>(field_.history[axis][stream]) * room_.scale.length;
            ++stream;
        }
        if (i < field_.count && j < field_.count) pair(i, j, spring, into);  // others fill the list up
    }
}

void ContactReader::wall(const Wall& wall, std::size_t w, double time, std::vector<ContactForce>& into) const {
    const Vec3 velocity = velocity_at(wall, time);
    const auto each_near = [&](const auto& shape, double middle) {
        for (std::int32_t k = field_.segments[w].begin; k < field_.segments[w].end; ++k) {
            const auto i = static_cast<std::int32_t>(field_.wall_particle[k] / places_per_index);
            if (i >= field_.count) continue;  // fills the segment up
            Vec3 x{}, spring{};
            for (std::size_t axis = 0; axis < 3; ++axis) {
                x[axis] = room_.scale.centre[axis] + field_.records[i].position[axis] * room_.scale.unit[axis];
                spring[axis] = static_cast<double>(field_.wall_history[axis][k]) * room_.scale.length;
            }
            if (room_.domain.periodic[0]) {  // the image nearest to the wall
                const double period = room_.domain.high[0] - room_.domain.low[0];
                x[0] -= period * std::nearbyint((x[0] - middle) / period);
            }
            const Closest closest = shape.closest(x);
            Touch<Partner::wall> t;
            t.radius_i = t.effective_radius = radius(i);
            t.distance = closest.distance;
            t.overlap = t.radius_i - closest.distance;
            if (!(t.overlap > 0)) continue;
            t.normal = closest.normal;
            t.reduced_mass = mass(i);
            const Motion& motion = motions_[static_cast<std::size_t>(i)];
            const Vec3 turn = (t.radius_i - t.overlap / 2) * motion.spin;
            add(t, i, -1 - static_cast<std::int32_t>(w), motion.velocity - velocity, turn, spring, into);
        }
    };
    if (const auto* plane = std::get_if<Plane>(&wall)) {
        each_near(shape_at(*plane, time), room_.scale.centre[0]);  // no plane cuts a periodic axis
    } else {
        const Bar bar = shape_at(std::get<Blade>(wall), time);
        each_near(bar, (bar.rear + bar.front) / 2);
    }
}

}  // namespace grainsweep::dem::fast
