// Search for loose parts of a surface and needles, which damaged files contain and which could be mistaken for the end
// of a body.
//
// part    triangles joined by common edges of two triangles, or by free edges (of one triangle) along each other, as
//         where two tessellations meet. A fin is a part of its own, because three triangles share its edge.
// loose   a part that has a free edge, or no thickness, or touches the others in one point or nowhere. Free edges at
//         the two ends of a surface along its width do not count: profiles are open there. Nor do those of a lip, a
//         part of an open surface that runs along at least half of the width.
// needle  the outermost triangles, at least five times as long as wide.
#pragma once

#include "solver/geometry/mesh.hpp"

#include <cstddef>
#include <optional>
#include <span>

namespace grainsweep::geometry {

/// End of a surface along one of six directions.
struct End {
    std::size_t axis = 0;
    bool high = false;
};

struct LooseTriangles {
    std::size_t count = 0;
    Vec3 outermost{};   ///< outermost corner
    double beyond = 0;  ///< distance beyond all other parts, m
};

/// Finds the loose parts that extend beyond all other parts at an end. Returns the first of them if together they have
/// at most `share` of the area. width: axis along which profiles are open at their ends and lips run.
[[nodiscard]] std::optional<LooseTriangles> loose_triangles(const Mesh& mesh, std::size_t width,
                                                            std::span<const End> ends, double share);

struct Needle {
    Vec3 tip{};
    double length = 0, width = 0;  ///< m; width halfway
};

/// Returns a needle with at most `share` of the area.
[[nodiscard]] std::optional<Needle> needle_at(const Mesh& mesh, const End& end, double share);

}  // namespace grainsweep::geometry
