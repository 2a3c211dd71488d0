// Shapes of a machine made of triangles, in their place: discs, rectangles, boxes and STL files.
#pragma once

#include "solver/geometry/shapes.hpp"
#include "solver/geometry/solid.hpp"

#include <array>
#include <optional>
#include <string_view>
#include <vector>

namespace grainsweep::machine {

using Triangles = std::vector<std::array<geometry::Vec3, 3>>;

/// Placement: rotation by an angle about an axis, right hand, then a shift.
struct Placement {
    geometry::Vec3 axis{0, 0, 1}, through{};
    double angle = 0;  ///< rad
    geometry::Vec3 at{};
};

/// Returns two triangles, the parallelogram from a corner.
[[nodiscard]] Triangles rectangle(const geometry::Vec3& corner, const geometry::Vec3& along,
                                  const geometry::Vec3& across);
/// Returns a disc, or a ring, of 64 facets with the area of the circle.
[[nodiscard]] Triangles disc(const geometry::Vec3& centre, const geometry::Vec3& normal, double radius, double inner);
/// Returns the faces of a box that are not open, in the order -x, +x, -y, +y, -z, +z.
[[nodiscard]] Triangles box(const geometry::Vec3& low, const geometry::Vec3& high, const std::array<bool, 6>& open);
/// Makes a mesh. Throws std::invalid_argument with one sentence for triangles without area and invalid numbers.
[[nodiscard]] geometry::Mesh mesh_of(Triangles triangles, double facet_angle, const Placement& placement);
/// Makes a mesh from the contents of an STL file. `scale`: length of its unit, m.
[[nodiscard]] geometry::Mesh stl_mesh(std::string_view contents, double scale, double facet_angle,
                                      const Placement& placement);

/// Returns the body that a closed mesh bounds; empty: the mesh is open, or the shape is no mesh.
[[nodiscard]] std::optional<geometry::Solid> solid_of(const geometry::Shape& shape);

}  // namespace grainsweep::machine
