// Particles of a run: spheres, and clumps, each of which is one particle of several spheres.
#include "solver/machine/run.hpp"

#include <array>
#include <string>
#include <vector>

namespace grainsweep::machine {

void Run::enlist(const Filled& filled) {
    const auto begin = static_cast<std::int32_t>(species_.size());
    for (std::size_t k = 0; k < filled.spheres.size(); ++k) {
        const Species& species = spec_.species[filled.species[k]];
        species_.push_back(filled.species[k]);
        density_.push_back(species.density(spec_.densities));
        radius_.push_back(filled.spheres[k].radius);
        if (has_clumps()) particle_.push_back(begin + static_cast<std::int32_t>(k));
    }
    for (const dem::Body& body : filled.bodies) {
        const std::size_t first = static_cast<std::size_t>(begin) + body.first;
        const std::size_t members = spec_.species[species_[first]].shape->balls.size();
        radius_[first] = body.scale / 2;
        for (std::size_t k = 1; k < members; ++k) {
            radius_[first + k] = 0;
            particle_[first + k] = static_cast<std::int32_t>(first);
        }
    }
}

std::int64_t Run::so_far() const {
    std::int64_t count = 0;
    if (!has_clumps()) return static_cast<std::int64_t>(species_.size());
    for (std::size_t id = 0; id < particle_.size(); ++id)
        count += static_cast<std::size_t>(particle_[id]) == id ? 1 : 0;
    return count;
}

std::int64_t Run::present() const {
    auto count = static_cast<std::int64_t>(engine_->size());
    if (!has_clumps()) return count;
    dem::State state;
    engine_->state(state);
    for (const dem::BodyState& clump : state.bodies) count -= static_cast<std::int64_t>(clump.members) - 1;
    return count;
}

/// Makes one particle of each clump.
void Run::gather_particles() {
    const dem::State& from = spheres_;
    dem::State& into = particles_;
    into = {};
    auto clump = from.bodies.begin();
    for (std::size_t i = 0; i < from.id.size();) {
        const bool first = clump != from.bodies.end() && clump->first == from.id[i];
        into.id.push_back(from.id[i]);
        into.mobile.push_back(from.mobile[i]);
        into.position.push_back(first ? clump->position : from.position[i]);
        into.velocity.push_back(first ? clump->velocity : from.velocity[i]);
        into.angular_velocity.push_back(first ? clump->angular_velocity : from.angular_velocity[i]);
        into.radius.push_back(first ? clump->scale / 2 : from.radius[i]);
        i += first ? clump->members : 1;
        if (first) ++clump;
    }
}

/// Adds, where there are clumps, the body of each sphere, its velocity, long axis and orientation.
void Run::add_orientations(Snapshot& picture) const {
    if (!has_clumps()) return;
    dem::State state;
    engine_->state(state);
    const std::size_t count = state.id.size();
    auto& body = picture.scalars["body"];
    auto& velocity = picture.vectors["body_velocity"];
    auto& axis = picture.vectors["long_axis"];
    std::array<std::vector<double>*, 4> parts{};
    for (std::size_t k = 0; k < 4; ++k)
        (parts[k] = &picture.scalars[std::string("orientation_") + "wxyz"[k]])->assign(count, k == 0 ? 1.0 : 0.0);
    body.assign(state.id.begin(), state.id.end());
    velocity = state.velocity;
    axis.assign(count, Vec3{});
    std::size_t i = 0;
    for (const dem::BodyState& clump : state.bodies) {
        while (state.id[i] != clump.first) ++i;
        const auto& shape = *spec_.species[species_[static_cast<std::size_t>(clump.first)]].shape;
        const auto turn = geometry::product(clump.orientation, geometry::conjugate(shape.turn));
        for (const std::size_t end = i + clump.members; i < end; ++i) {
            body[i] = clump.first;
            velocity[i] = clump.velocity;
            axis[i] = dem::axes_of(clump.orientation)[shape.long_axis()];
            for (std::size_t k = 0; k < 4; ++k) (*parts[k])[i] = turn[k];
        }
    }
    picture.units["body_velocity"] = "m/s";
}

}  // namespace grainsweep::machine
