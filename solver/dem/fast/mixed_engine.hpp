// The fast engine: mixed precision and vector instructions, with the laws of solver/dem/laws.
//
// Scheme and laws are those of the double-precision engine (velocity Verlet, half-step velocities in the law).
// Positions are exact integers, and R^2 - r^2 is computed in double precision. All other numbers are in single
// precision, with the rounding errors of position and velocity carried to the next step. A contact then agrees with
// double precision to about 1e-6 of its largest force. The energy error of a collision has the same order.
//
// A particle beyond an open face is removed at the next rebuild of the lists, before it is a skin (0.2 to 0.7 largest
// diameters) past the face.
#pragma once

#include <memory>

#include "solver/dem/engine.hpp"
#include "solver/dem/fast/instruction_path.hpp"
#include "solver/dem/fast/threads.hpp"

namespace grainsweep::dem::fast {

/// Overlap divided by the smaller diameter (for a wall: by the diameter) above which a state is unsound.
inline constexpr double overlap_limit = 0.3;
/// Displacement per step and axis, divided by the smallest diameter, above which a state is unsound.
inline constexpr double travel_limit = 0.25;

/// Makes the engine. Positions are multiples of a period divided by 2^32, or of about an open extent divided by 2^31;
/// forces are rounded to 1e-7. `skin` (m): of the outer neighbour list; 0: chosen from the motion. `rest_speed`: as in
/// Method. The number of threads changes no bit (subdomains.hpp). Throws std::invalid_argument with one sentence for an
/// impossible setup or a path that this processor lacks.
[[nodiscard]] std::unique_ptr<Engine> make_mixed_engine(const Setup& setup, Method::Path path, double skin = 0,
                                                        double rest_speed = 0, Threads threads = {});

}  // namespace grainsweep::dem::fast
