// What spreads the powder: a blade, a roller or a surface from an STL file, and where it stands.
//
// A tool has three planes across the travel. Its foremost point touches the layer's end at the start. Behind its edge
// powder has passed: the front face of a blade, the axis of a roller, the foremost of the lowest points of a surface.
// Behind its rear the layer is free: the rear face of a blade, the axis of a roller, the rearmost point of a surface.
// The lowest point of the tool is at height `gap` over the level it spreads on.
//
//     roller: v(surface) = speed (1 + spin) at its lowest point, so angular velocity -spin speed/R about y
#pragma once

#include "solver/dem/walls/wall.hpp"
#include "solver/geometry/mesh.hpp"

#include <string_view>

namespace grainsweep::spreading {

enum class Tool { blade, roller, file };
enum class Base { smooth, rough };

/// Share of a tool's surface that a stray piece or a needle has at most.
inline constexpr double small_share = 0.02;

struct Study;

/// The tool as its wall, over a level, m.
[[nodiscard]] dem::Wall tool_wall(const Study& study, double level);

/// The surface in an STL file, fitted(). Kept for the next call with the same arguments. Throws std::invalid_argument
/// with one sentence where it is no tool: larger than half a metre, with stray triangles, or not fitting.
[[nodiscard]] geometry::Mesh tool_surface(std::string_view stl, double scale, double facet_angle, double width);

/// A surface from y = 0 to `width`, its lowest point at z = 0 and x = 0. Throws std::invalid_argument with one sentence
/// where it is shorter than the width, or longer and no profile.
[[nodiscard]] geometry::Mesh fitted(const geometry::Mesh& given, double width);

}  // namespace grainsweep::spreading
