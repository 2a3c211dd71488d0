// Shapes of a machine that are made of triangles: discs, rectangles, boxes and STL files, where they are placed.
#pragma once

#include "solver/geometry/shapes.hpp"
#include "solver/geometry/solid.hpp"

#include <array>
#include <optional>
#include <string_view>
#include <vector>

namespace grainsweep::machine {

using Triangles = std::vector<std::array<geometry::Vec3, 3>>;

/// Turned by an angle about an axis, right hand, then shifted.
struct Placement {
    geometry::Vec3 axis{0, 0, 1}, through{};
    double angle = 0;  ///< rad
    geometry::Vec3 at{};
};

/// Two triangles: the parallelogram from a corner.
[[nodiscard]] Triangles rectangle(const geometry::Vec3& corner, const geometry::Vec3& along,
                                  const geometry::Vec3& across);
/// A disc, or a ring, of 64 facets with the area of the circle.
[[nodiscard]] Triangles disc(const geometry::Vec3& centre, const geometry::Vec3& normal, double radius, double inner);
/// The faces of a box that are not open, in the order -x, +x, -y, +y, -z, +z.
[[nodiscard]] Triangles box(const geometry::Vec3& low, const geometry::Vec3& high, const std::array<bool, 6>& open);
/// Throws std::invalid_argument with one sentence on triangles without area or numbers that are none.
[[nodiscard]] geometry::Mesh mesh_of(Triangles triangles, double facet_angle, const Placement& placement);
/// The same of the contents of an STL file, with the length of its unit, m.
[[nodiscard]] geometry::Mesh stl_mesh(std::string_view contents, double scale, double facet_angle,
                                      const Placement& placement);

/// The body that a closed mesh bounds; nullopt: it is open, or another shape.
[[nodiscard]] std::optional<geometry::Solid> solid_of(const geometry::Shape& shape);

}  // namespace grainsweep::machine
