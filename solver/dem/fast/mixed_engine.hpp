// The fast door: spheres with tangential history in mixed precision, vectorised; laws as in solver/dem/laws.
//
// Same scheme and law as the double-precision engine (velocity Verlet, half-step velocities in the law). Positions are
// exact integers, and R^2 - r^2 is formed in double precision. The rest is in single precision, with the rounding of
// position and velocity carried along. A contact then agrees with double precision to about 1e-6 of its largest
// force; the error of energy over a collision is of that order.
//
// A particle beyond an open face is removed when the lists are next rebuilt: before it is a skin (0.2 to 0.7
// largest diameters) past the face.
#pragma once

#include <memory>

#include "solver/dem/engine.hpp"
#include "solver/dem/fast/instruction_path.hpp"
#include "solver/dem/fast/threads.hpp"

namespace grainsweep::dem::fast {

/// Overlap over the smaller diameter (for a wall: over the diameter) beyond which a state is not trusted.
inline constexpr double overlap_limit = 0.3;
/// Displacement per step, per axis, over the smallest diameter, beyond which a state is not trusted.
inline constexpr double travel_limit = 0.25;

/// Precision: positions are multiples of a period divided by 2^32, or of about an open extent divided by 2^31; forces
/// are rounded to 1e-7. `skin` (m): of the outer neighbour list, 0: chosen from the motion. `rest_speed`: as in Method.
/// The number of threads changes no bit (subdomains.hpp).
/// Throws std::invalid_argument with one sentence on an impossible setup or a path this processor lacks.
[[nodiscard]] std::unique_ptr<Engine> make_mixed_engine(const Setup& setup, Method::Path path, double skin = 0,
                                                        double rest_speed = 0, Threads threads = {});

}  // namespace grainsweep::dem::fast
