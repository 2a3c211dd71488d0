#include "solver/dem/body_columns.hpp"

#include <cmath>

namespace grainsweep::dem {

using namespace geometry;

void BodyColumns::append(std::span<const Body> bodies, std::size_t id) {
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

void BodyColumns::derive() {
    mass.resize(size());
    inverse_mass.resize(size());
    inertia.resize(size());
    inverse_inertia.resize(size());
    for (std::size_t b = 0; b < size(); ++b) {
        mass[b] = mass_of(shape_of(b), scale[b]);
        inverse_mass[b] = 1 / mass[b];
        inertia[b] = inertia_of(shape_of(b), scale[b]);
        inverse_inertia[b] = inverse_of(inertia[b]);
    }
}

void BodyColumns::remove(const std::vector<bool>& leaving) {
    for_each_column(*this, [&](auto& column) {
        std::size_t kept = 0;
        for (std::size_t b = 0; b < column.size(); ++b)
            if (!leaving[b]) column[kept++] = column[b];
        column.resize(kept);
    });
    derive();
}

BodyState BodyColumns::state(std::size_t b) const {
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

bool BodyColumns::possible() const {
    bool holds = true;
    for_each_column(*this, [&](const auto& column) { holds = holds && column.size() == size(); });
    for (std::size_t b = 0; holds && b < size(); ++b)
        holds = first[b] >= 0 && shape[b] < shapes_.size() && scale[b] > 0 && std::isfinite(scale[b]) &&
                finite(position[b]) && finite(velocity[b]) && finite(momentum[b]) &&
                std::abs(magnitude(orientation[b]) - 1) < 1e-9;
    return holds;
}

}  // namespace grainsweep::dem
