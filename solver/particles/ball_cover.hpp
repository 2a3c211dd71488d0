// Spheres that cover a closed surface: the shape of a clump from a mesh.
//
// Balls are inscribed about points of the body and swollen by a share of its shortest side, so that they fill its
// corners. The ball that covers most of what is not yet covered is taken, again and again. The points are the same for
// the same surface.
#pragma once

#include "solver/geometry/ball_union.hpp"
#include "solver/geometry/triangle_surface.hpp"

#include <optional>
#include <vector>

namespace grainsweep::particles {

struct CoverRequest {
    std::size_t most = 16;          ///< spheres
    std::optional<double> error{};  ///< enough spheres where one minus the overlap is at most this
};

/// Default end of a cover: a further sphere would cover less than this share of the body.
inline constexpr double least_gain = 5e-3;
/// The same where an error was asked for.
inline constexpr double least_gain_of_error = 1e-3;

struct BallCover {
    std::vector<geometry::Ball> balls;  ///< scaled so that their union has the volume of the body
    double overlap = 0;                 ///< volume that body and spheres share, divided by the volume of either
    double smallest = 0;                ///< radius divided by the largest one
};

/// Returns a cover of the body that a closed surface bounds. Throws std::invalid_argument with one sentence for a
/// surface that is not closed, for a body so thin that no ball fits, and for an error that no cover has.
[[nodiscard]] BallCover ball_cover(const geometry::TriangleSurface& surface, const CoverRequest& request);

}  // namespace grainsweep::particles
