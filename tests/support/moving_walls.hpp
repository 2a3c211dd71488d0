// One sphere, and walls that move and turn in all ways.
#pragma once

#include <vector>

#include "solver/dem/engine.hpp"

namespace grainsweep::tests {

inline constexpr double sphere_at_walls = 1e-3;  ///< radius, m

/// A sphere without gravity in a box of 0.1 m; a step of 1 us.
[[nodiscard]] dem::Setup one_sphere(const dem::Vec3& x, const dem::Vec3& v, std::vector<dem::Wall> walls);

/// A wall, and a sphere that soon hits it.
struct Moving {
    const char* name;
    dem::Wall wall;
    dem::Vec3 position, velocity;
};

[[nodiscard]] std::vector<Moving> moving_walls();
/// Triangle meshes; the sphere hits a face, an edge or a vertex.
[[nodiscard]] std::vector<Moving> moving_meshes();
/// All of them.
[[nodiscard]] std::vector<Moving> all_moving_walls();

}  // namespace grainsweep::tests
