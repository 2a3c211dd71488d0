// Shapes of a machine made of triangles, in their place: discs, rectangles, perforated plates, boxes and STL files.
#pragma once

#include "solver/field.hpp"
#include "solver/geometry/shapes.hpp"
#include "solver/geometry/solid.hpp"

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <variant>
#include <vector>

namespace grainsweep::machine {

using Triangles = std::vector<std::array<geometry::Vec3, 3>>;

/// Placement: rotation by an angle about an axis, right hand, then a shift.
struct Placement {
    geometry::Vec3 axis{0, 0, 1}, through{};
    double angle = 0;  ///< rad
    geometry::Vec3 at{};
};

// Flat shapes: bodies of triangles.
struct Rectangle {
    geometry::Vec3 corner{}, along{}, across{};  ///< m; two sides from a corner
};
struct Disc {
    geometry::Vec3 centre{};         ///< m
    geometry::Vec3 normal{0, 0, 1};  ///< unit
    double radius = 0, inner = 0;    ///< m
};
struct Box {
    geometry::Vec3 low{}, high{};  ///< m
    std::array<bool, 6> open{};    ///< faces that are left out: -x, +x, -y, +y, -z, +z
};

/// Flat plate with round holes in rows, as many as fit; the rest is shared between opposite edges.
struct Perforated {
    enum class Pattern { square, triangular };
    geometry::Vec3 corner{}, along{}, across{};  ///< m; two sides from a corner, at a right angle
    double hole = 0;                             ///< diameter, m
    double pitch = 0;                            ///< between the centres of neighbours, m
    Pattern pattern = Pattern::square;           ///< rows are parallel to `along`
};

/// Shape as a machine file states it.
using StatedShape = std::variant<geometry::Plane, Rectangle, Perforated, Disc, Box, geometry::Cylinder, geometry::Cone,
                                 geometry::Tube, geometry::Bar>;
/// Returns the alternatives of a StatedShape with the fields that a file sets.
[[nodiscard]] std::span<const Type> shape_types();
[[nodiscard]] std::span<const Field> placement_fields();

/// Returns two triangles.
[[nodiscard]] Triangles triangles_of(const Rectangle& rectangle);
/// Returns triangles with a polygon of 32 sides around the circle of each hole.
[[nodiscard]] Triangles triangles_of(const Perforated& plate);
/// Returns 64 facets with the area of the circle.
[[nodiscard]] Triangles triangles_of(const Disc& disc);
/// Returns the faces that are not open, in the order -x, +x, -y, +y, -z, +z.
[[nodiscard]] Triangles triangles_of(const Box& box);
template <class S>
inline constexpr bool is_flat = requires(const S& shape) {
    triangles_of(shape);
};
/// Makes a mesh. Throws std::invalid_argument with one sentence for triangles without area and invalid numbers.
[[nodiscard]] geometry::Mesh mesh_of(Triangles triangles, double facet_angle, const Placement& placement);
/// Makes a mesh from the contents of an STL file. `scale`: length of its unit, m.
[[nodiscard]] geometry::Mesh stl_mesh(std::string_view contents, double scale, double facet_angle,
                                      const Placement& placement);

/// Largest share of a surface that counts as a stray piece or a needle.
inline constexpr double small_share = 0.02;
/// Makes a mesh from an STL file that is `width` long along y, from y = 0 on, with its lowest point, of several the
/// foremost, at x = 0 and z = 0. It is stored for the next call with the same arguments. Throws std::invalid_argument
/// with one sentence if it is shorter, or longer and no profile, larger than half a metre, or has stray triangles.
[[nodiscard]] geometry::Mesh fitted_mesh(std::string_view stl, double scale, double facet_angle, double width);

/// Returns the body that a closed mesh bounds; empty: the mesh is open, or the shape is no mesh.
[[nodiscard]] std::optional<geometry::Solid> solid_of(const geometry::Shape& shape);

}  // namespace grainsweep::machine
