// Body that spheres make together, evenly filled: each place counts once, also where spheres overlap.
#pragma once

#include "solver/geometry/solid.hpp"

#include <span>
#include <vector>

namespace grainsweep::geometry {

struct Ball {
    Vec3 centre{};      ///< m
    double radius = 0;  ///< m

    bool operator==(const Ball&) const = default;
};

/// Returns volume, centre and inertia of the union of balls, to about 1e-12. Every slice across z is a union of
/// circles; its area and moments are integrals over the arcs of its outline (Green's theorem), in closed form. Between
/// the heights at which arcs appear or vanish Gauss's rule sums the slices. Positive finite radii; at least one ball.
[[nodiscard]] Solid solid_of(std::span<const Ball> balls);

}  // namespace grainsweep::geometry
