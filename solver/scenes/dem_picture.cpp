#include "solver/scenes/dem_picture.hpp"

#include "solver/observables/particle_loads.hpp"

#include <utility>
#include <vector>

namespace grainsweep {

Snapshot picture_of(const dem::Engine& engine) {
    dem::State state;
    std::vector<dem::ContactForce> contacts;
    engine.state(state);
    engine.contacts(contacts);
    auto loads = observables::particle_loads(state, contacts);
    Snapshot picture;
    picture.positions = std::move(state.position);
    picture.scalars["id"].assign(state.id.begin(), state.id.end());
    picture.scalars["mobile"].assign(state.mobile.begin(), state.mobile.end());
    for (const double radius : state.radius) picture.scalars["diameter"].push_back(2 * radius);
    picture.scalars["overlap"] = std::move(loads.overlap);
    picture.scalars["largest_force"] = std::move(loads.largest);
    picture.scalars["coordination"] = std::move(loads.coordination);
    picture.vectors["velocity"] = std::move(state.velocity);
    picture.vectors["angular_velocity"] = std::move(state.angular_velocity);
    picture.vectors["force"] = std::move(loads.force);
    return picture;
}

}  // namespace grainsweep
