// The hopper in numbers.
//
// Geometry: z up, the opening in the plane z = 0.
//     round    a cylinder about z; 'flat': a floor a tenth of D thick with a sharp-edged hole; 'conical': a cone from
//              the hole up to the cylinder
//     slot     a box |x| <= container_diameter/2, periodic along y; a flat floor with a slot along y
// The powder starts as a loose random filling above a closed opening, falls and settles; then the opening is there at
// once. What falls through is gone four diameters below.
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/particles/size_distribution.hpp"
#include "solver/scenes/values.hpp"

#include <cstdint>
#include <vector>

namespace grainsweep::hopper {

struct Study {
    dem::Material material;
    dem::Surface wall;
    particles::SizeDistribution sizes;  ///< of d/D
    double diameter = 0;                ///< D, m
    bool conical = false, slot = false;
    double cone_tangent = 0;             ///< of the angle to the vertical
    double half_width = 0, opening = 0;  ///< of the container, radius or half; whole opening, m
    double slot_length = 0;
    double gravity = 0;
    std::int64_t particles = 0;
    double time_step = 0, frame_interval = 0, stop_share = 1;
    std::int64_t settle_steps = 0, frames = 0;  ///< frames: most, from the opening on

    /// Height of the cone, 0 over a flat floor.
    [[nodiscard]] double cone_height() const;
    [[nodiscard]] double section() const;      ///< of the container, m2
    [[nodiscard]] double fill_height() const;  ///< of the loose filling, m
    [[nodiscard]] std::int64_t step_of_frame(std::int64_t frame) const;
    /// Since the opening, s.
    [[nodiscard]] double time_of_frame(std::int64_t frame) const;
    [[nodiscard]] double quiet_time() const;  ///< without outflow after which the flow has ceased, s
};

/// Throws std::invalid_argument with one sentence where the inputs are impossible together or a file is not given.
[[nodiscard]] Study study_of(const Inputs& inputs, const Files& files);

/// The loose filling above the closed opening; its walls: container, cone, plug.
[[nodiscard]] dem::Setup closed(const Study& study, std::uint64_t seed);
/// Container, and cone or floor.
[[nodiscard]] std::vector<dem::Wall> open_walls(const Study& study);

/// Grows whenever answers change on purpose.
inline constexpr int revision = 1;

}  // namespace grainsweep::hopper
