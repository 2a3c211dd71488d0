// Tool that spreads the powder: a blade, a roller or a surface from an STL file, and its position.
//
// A tool has three planes across the travel. The plane of its foremost point touches the end of the layer at the start.
// Powder behind the plane of its edge has passed the tool: the edge is the front face of a blade, the axis of a roller,
// or the foremost of the lowest points of a surface. Behind the plane of its rear the layer is free: the rear face of a
// blade, the axis of a roller, or the rearmost point of a surface. The lowest point of the tool is at height `gap`
// above the level.
//
//     roller: v(surface) = speed (1 + spin) at its lowest point, so angular velocity -spin speed/R about y
#pragma once

#include "solver/dem/walls/wall.hpp"
#include "solver/geometry/mesh.hpp"

#include <string_view>

namespace grainsweep::spreading {

enum class Tool { blade, roller, file };
enum class Base { smooth, rough };

/// Largest share of a tool's surface that counts as a stray piece or a needle.
inline constexpr double small_share = 0.02;

struct Study;

/// Returns the wall of the tool above a level, m.
[[nodiscard]] dem::Wall tool_wall(const Study& study, double level);

/// Returns the surface in an STL file after fitted(). It is stored for the next call with the same arguments. Throws
/// std::invalid_argument with one sentence if it is no tool: larger than half a metre, with stray triangles, or not
/// fitting.
[[nodiscard]] geometry::Mesh tool_surface(std::string_view stl, double scale, double facet_angle, double width);

/// Returns the surface from y = 0 to `width`, with its lowest point at z = 0 and x = 0. Throws std::invalid_argument
/// with one sentence if it is shorter than the width, or longer and no profile.
[[nodiscard]] geometry::Mesh fitted(const geometry::Mesh& given, double width);

}  // namespace grainsweep::spreading
