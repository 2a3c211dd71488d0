// A sphere alone in a closed box of fluid, two-way coupled: does it feel its own wake?
#pragma once

#include "solver/coupling/self_disturbance.hpp"
#include "solver/coupling/suspension.hpp"
#include "tests/support/flow_boxes.hpp"

#include <type_traits>
#include <vector>

namespace grainsweep::tests::lone_sphere {

using namespace flow_boxes;

using Subtracted = TwoWayWithoutOwnWake;
using Kept = TwoWay;

inline constexpr double dt = 1e-5, acceleration = 9e4;

[[nodiscard]] inline Sphere sphere_along(int axis) {
    return {1.65, 3.1e-6, 18, acceleration, axis};
}

struct Place {
    Grid grid;
    double width;  ///< of the kernel
    Vec3 x;
    int axis;  ///< of the force
};

template <class Level>
Level level_at(const Place& at) {
    const Sphere sphere = sphere_along(at.axis);
    if constexpr (std::is_same_v<Level, Subtracted>)
        return {at.grid, closed, sphere, 1, at.width, dt};
    else if constexpr (std::is_same_v<Level, Kept>)
        return {at.grid, closed, sphere, 1, at.width};
    else
        return {};
}

/// The velocity along the force after every step.
template <class Level>
std::vector<double> velocities(const Place& at, const flow::Vibration& vibration, int steps) {
    const Sphere sphere = sphere_along(at.axis);
    Suspension<flow::NoHeat, Level, Trilinear, StokesDrag> together(
        still_fluid(at.grid, closed, sphere.prandtl, dt), vibration, Motion<StokesDrag>(sphere, dt), box(closed, 0),
        Cloud{{at.x}, {Vec3{}}}, level_at<Level>(at));
    std::vector<double> found;
    for (int s = 0; s < steps; ++s) {
        together.step();
        found.push_back(together.cloud().velocity[0][static_cast<std::size_t>(at.axis)]);
    }
    return found;
}

/// Settling velocity over that of Stokes' law, once the flow is steady.
template <class Level>
double settling(const Place& at) {
    const Sphere sphere = sphere_along(at.axis);
    const double stokes = (sphere.density_ratio - 1) * acceleration * sphere.stokes / sphere.prandtl;
    return velocities<Level>(at, {}, 600).back() / stokes;
}

}  // namespace grainsweep::tests::lone_sphere
