// What a case of the heap answers. Definitions as functions: solver/observables/heap.hpp.
#pragma once

#include "solver/scenes/kit/powder.hpp"

namespace grainsweep::heap::record {

inline constexpr kit::Scalar angle{
    "angle", "deg",
    "static angle of repose by the outline: slope of the line through the rings between 0.2 and 0.8 of the height; "
    "undefined for fewer than two rings",
    "fewer than two rings lie between 0.2 and 0.8 of the height: too few particles, or none on the plate"};
inline constexpr kit::Scalar angle_residual{
    "angle_residual", "1", "root mean square height of the outline off that line, over D",
    "fewer than two rings lie between 0.2 and 0.8 of the height: too few particles, or none on the plate"};
inline constexpr kit::Scalar angle_moment{
    "angle_moment", "deg",
    "static angle of repose by moments: atan(2 z_c/<r>) of the particles within the first ring lower than D/2, exact "
    "for a cone of even density; scatters a fifth as much as angle",
    "all particles lie on one axis, or none on the plate"};
inline constexpr kit::Scalar height{"height", "m", "largest height of the inner three rings of the outline",
                                    "no particle is left on the plate"};
inline constexpr kit::Scalar run_out{"run_out", "m",
                                     "distance from the mass centre within which nine tenths of the particles lie",
                                     "no particle is left on the plate"};
inline constexpr kit::Scalar at_rest{"at_rest", "1",
                                     "1: at the end the root mean square speed is below 3e-5 sqrt(g D); 0: it is not"};
inline constexpr kit::Scalar rms_speed{"rms_speed", "m/s", "root mean square speed of the particles at the end"};
inline constexpr kit::Scalar max_overlap{
    "max_overlap", "1", "largest overlap of two particles over the smaller diameter, over all steps since the start"};
inline constexpr kit::Scalar particles{
    "particles", "1", "particles on the plate at the end: those that rolled out of the calculation are not"};
inline constexpr kit::Profile outline{
    "outline", "m",
    "height over the plate, mean over rings of width D about the mass centre of the highest surface in columns of D by "
    "D; bin: radius of the ring's middle",
    "radius (m)"};

[[nodiscard]] inline std::vector<ObservableSpec> observables() {
    return kit::observed(angle, angle_residual, angle_moment, height, run_out, at_rest, rms_speed, max_overlap,
                         particles, kit::bond_number, outline);
}

}  // namespace grainsweep::heap::record
