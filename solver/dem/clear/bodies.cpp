#include "solver/dem/clear/bodies.hpp"

namespace grainsweep::dem::clear {

using namespace geometry;

bool Bodies::map(std::span<const std::int32_t> id, std::size_t ids) {
    begin_.assign(1, 0);
    member_.clear();
    if (empty()) {
        body_of_.clear();
        lever_.clear();
        return true;
    }
    std::vector<std::uint32_t> place(ids, lone);
    for (std::uint32_t i = 0; i < id.size(); ++i) place[static_cast<std::size_t>(id[i])] = i;
    body_of_.assign(id.size(), lone);
    lever_.assign(id.size(), Vec3{});
    offset.resize(id.size());
    for (std::size_t b = 0; b < size(); ++b) {
        for (std::size_t k = 0; k < shape_of(b).members.size(); ++k) {
            const std::size_t of = static_cast<std::size_t>(first[b]) + k;
            if (of >= ids || place[of] == lone || body_of_[place[of]] != lone) return false;
            body_of_[place[of]] = static_cast<std::uint32_t>(b);
            member_.push_back(place[of]);
        }
        begin_.push_back(static_cast<std::uint32_t>(member_.size()));
        set_levers(b);
    }
    return true;
}

void Bodies::set_levers(std::size_t b) {
    const auto of = members(b);
    const Axes now = axes(b);
    for (std::size_t k = 0; k < of.size(); ++k) lever_[of[k]] = in_space(now, scale[b] * shape_of(b).members[k].place);
}

void Bodies::gather(const particles::Particles& spheres) {
    for (std::size_t b = 0; b < size(); ++b) {
        Vec3 f{}, t{};
        for (const std::uint32_t i : members(b)) {
            f += spheres.force[i];
            t += cross(lever_[i], spheres.force[i]) + spheres.torque[i];
        }
        force[b] = f;
        torque[b] = t;
    }
}

void Bodies::kick_and_drift(double span, const Vec3& acceleration, particles::Particles& spheres) {
    for (std::size_t b = 0; b < size(); ++b) {
        kick_body(b, span / 2, acceleration);
        drift_body(b, span);
        set_levers(b);
        for (const std::uint32_t i : members(b)) spheres.position[i] = position[b] + lever_[i] + offset[i];
        set_velocities(b, spheres);
    }
}

void Bodies::kick(double span, const Vec3& acceleration, particles::Particles& spheres) {
    for (std::size_t b = 0; b < size(); ++b) {
        kick_body(b, span / 2, acceleration);
        spin[b] = spin_of(momentum[b], axes(b), inverse_inertia[b]);
        set_velocities(b, spheres);
    }
}

void Bodies::set_velocities(std::size_t b, particles::Particles& spheres) const {
    for (const std::uint32_t i : members(b)) {
        spheres.velocity[i] = velocity[b] + cross(spin[b], lever_[i]);
        spheres.angular_velocity[i] = spin[b];
    }
}

}  // namespace grainsweep::dem::clear
