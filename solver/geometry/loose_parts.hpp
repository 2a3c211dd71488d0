// Parts of a surface that no edge joins to the rest, and needles: what damaged files leave behind, and what would pass
// for the end of a body.
//
// part    triangles joined by edges that two of them have, or by a free edge (of one triangle) that lies along a free
//         edge of another, as where two tessellations meet. A fin is a part: three triangles have its edge.
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

/// One of the six ends of a surface.
struct End {
    std::size_t axis = 0;
    bool high = false;
};

struct LooseTriangles {
    std::size_t count = 0;
    Vec3 outermost{};   ///< a corner
    double beyond = 0;  ///< reach beyond all others, m
};

/// Returns the first of the loose parts that reach beyond all others at an end and have at most `share` of the area
/// together. width: axis along which profiles are open at their ends and lips run.
[[nodiscard]] std::optional<LooseTriangles> loose_triangles(const Mesh& mesh, std::size_t width,
                                                            std::span<const End> ends, double share);

struct Needle {
    Vec3 tip{};
    double length = 0, width = 0;  ///< m; width halfway
};

/// A needle with at most `share` of the area.
[[nodiscard]] std::optional<Needle> needle_at(const Mesh& mesh, const End& end, double share);

}  // namespace grainsweep::geometry
