#include "solver/dem/clear/bodies.hpp"

namespace grainsweep::dem::clear {

using namespace geometry;

void Bodies::append(std::span<const Body> bodies, std::size_t id) {
    for (const Body& body : bodies) {
        first.push_back(static_cast<std::int32_t>(id + body.first));
        shape.push_back(static_cast<std::uint32_t>(body.shape));
        scale.push_back(body.scale);
        position.push_back(body.position);
        velocity.push_back(body.velocity);
        orientation.push_back(normalised(body.orientation));
        spin.push_back(body.angular_velocity);
        spin_in_step.push_back(body.angular_velocity);
        momentum.push_back(momentum_of(body.angular_velocity, axes_of(orientation.back()),
                                       inertia_of(shapes_[body.shape], body.scale)));
        force.push_back({});
        torque.push_back({});
        position_at_build.push_back(body.position);
    }
    derive();
}

void Bodies::derive() {
    mass.resize(size());
    inertia.resize(size());
    axes.resize(size());
    for (std::size_t b = 0; b < size(); ++b) {
        mass[b] = mass_of(shape_of(b), scale[b]);
        inertia[b] = inertia_of(shape_of(b), scale[b]);
        axes[b] = axes_of(orientation[b]);
    }
}

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

void Bodies::remove(const std::vector<bool>& leaving) {
    for_each_column(*this, [&](auto& column) {
        std::size_t kept = 0;
        for (std::size_t b = 0; b < column.size(); ++b)
            if (!leaving[b]) column[kept++] = column[b];
        column.resize(kept);
    });
    derive();
}

void Bodies::set_levers(std::size_t b) {
    const auto& shape_members = shape_of(b).members;
    const auto of = members(b);
    for (std::size_t k = 0; k < of.size(); ++k) lever_[of[k]] = in_space(axes[b], scale[b] * shape_members[k].place);
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
        half_kick(b, span / 2, acceleration);
        position[b] += span * velocity[b];
        spin[b] = spin_in_step[b] = turn(orientation[b], momentum[b], inertia[b], span);
        axes[b] = axes_of(orientation[b]);
        set_levers(b);
        for (const std::uint32_t i : members(b)) spheres.position[i] = position[b] + lever_[i] + offset[i];
        set_velocities(b, spheres);
    }
}

void Bodies::kick(double span, const Vec3& acceleration, particles::Particles& spheres) {
    for (std::size_t b = 0; b < size(); ++b) {
        half_kick(b, span / 2, acceleration);
        spin[b] = spin_of(momentum[b], axes[b], inertia[b]);
        set_velocities(b, spheres);
    }
}

void Bodies::set_velocities(std::size_t b, particles::Particles& spheres) const {
    for (const std::uint32_t i : members(b)) {
        spheres.velocity[i] = velocity[b] + cross(spin[b], lever_[i]);
        spheres.angular_velocity[i] = spin[b];
    }
}

BodyState Bodies::state(std::size_t b) const {
    return {.first = first[b],
            .members = static_cast<std::uint32_t>(shape_of(b).members.size()),
            .shape = shape[b],
            .scale = scale[b],
            .position = position[b],
            .orientation = orientation[b],
            .velocity = velocity[b],
            .angular_velocity = spin[b],
            .angular_momentum = momentum[b],
            .mass = mass[b],
            .inertia = inertia[b]};
}

}  // namespace grainsweep::dem::clear
