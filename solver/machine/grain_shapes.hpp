// Shapes of species, as files describe them.
#pragma once

#include "solver/geometry/solid.hpp"
#include "solver/particles/ball_cover.hpp"
#include "solver/particles/clump.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace grainsweep::machine {

/// Returns the cost of a step of a clump of this many spheres divided by that of a sphere: bench_clumps, 4,000 spheres
/// in mixed precision on one core.
[[nodiscard]] constexpr double cost_of_clump(std::size_t spheres) {
    constexpr double of_body = 2.1, of_member = 0.4;
    return of_body + of_member * static_cast<double>(spheres);
}

/// Shape of a species, and how well it fits a mesh.
struct GrainShape {
    particles::Clump clump;
    std::vector<geometry::Ball> balls;  ///< in the frame and the unit in which it was described
    geometry::Solid solid;              ///< likewise: the union of the spheres, or the mesh
    std::optional<double> overlap{};    ///< volume that mesh and spheres share, divided by the volume of either
};

/// Mass, moments and centre that replace those of an evenly filled shape.
struct OwnMass {
    std::optional<double> mass{};                ///< kg
    std::optional<geometry::Inertia> inertia{};  ///< about the centre of mass, kg m2
    std::optional<geometry::Vec3> centre{};      ///< in the frame and the unit of the description
};

/// Returns a row of spheres (particles::row_of).
[[nodiscard]] GrainShape row_shape(double aspect_ratio);
/// Returns the shape of given spheres. Throws std::invalid_argument with one sentence for spheres that are no shape.
[[nodiscard]] GrainShape ball_shape(std::vector<geometry::Ball> balls);
/// Returns the cover of the body in an STL file, with volume, centre and inertia of the body. Throws
/// std::invalid_argument with one sentence for a file that is no closed surface. The last results are kept.
[[nodiscard]] GrainShape mesh_shape(std::string_view contents, const particles::CoverRequest& request);
/// Gives a shape another mass, for particles of a diameter, m, and a density, kg/m3. Throws std::invalid_argument with
/// one sentence for a mass that no such body has.
void take_mass(GrainShape& shape, const OwnMass& own, double diameter, double density);

}  // namespace grainsweep::machine
