// Wall from an STL file, as parameters of a scene: the file, its unit of length, and the angle up to which facets
// represent a curved surface.
//
//     inline constexpr StlWall tool = stl_wall("tool_file", "tool that spreads the powder: an STL file",
//                                              "tool_scale", "tool_facet_angle");
//     info.parameters = declared(powder.friction, tool.file, tool.scale, tool.facet_angle);
//     if (tool.given(inputs)) walls.push_back({tool.mesh(inputs, files), motions});
#pragma once

#include "solver/geometry/mesh.hpp"
#include "solver/scenes/kit/parameter.hpp"

#include <string_view>

namespace grainsweep::kit {

/// Returns the surface in the contents of an STL file, m. Throws std::invalid_argument with the parameter's name and
/// the reason.
[[nodiscard]] geometry::Mesh mesh_of(std::string_view parameter, std::string_view contents, double scale,
                                     double facet_angle);

struct StlWall {
    FileOr file;
    Real scale, facet_angle;

    /// Returns whether there is a file.
    [[nodiscard]] bool given(const Inputs& inputs) const { return file(inputs); }
    /// Returns the surface in its place in the file, m. Throws std::invalid_argument with the parameter's name and the
    /// reason if the file is not given or has no such surface.
    [[nodiscard]] geometry::Mesh mesh(const Inputs& inputs, const Files& files) const;
};

/// Throws std::invalid_argument with one sentence if the contents are no STL with a triangle.
void require_stl(std::string_view contents);

[[nodiscard]] constexpr StlWall stl_wall(std::string_view file, std::string_view meaning, std::string_view scale,
                                         std::string_view facet_angle, Conditions only = {}) {
    return {{file, meaning, "none", require_stl, only},
            {scale, "m", "length of the STL file's unit: 0.001 for files in mm", 1e-3, above(0, 1e3), only},
            {facet_angle,
             "deg",
             "facets of the STL file that meet at less than this angle stand for a curved surface: a particle touches "
             "one of them at a time; above the angle between such facets, below that of every true edge; 0: all are "
             "flat",
             0.0,
             {0, 44},
             only}};
}

}  // namespace grainsweep::kit
