// Beds, chutes and the spreading scene, made in the program: the states whose cost per step is compared.
#pragma once

#include <cstdint>
#include <filesystem>

#include "solver/dem/engine.hpp"

namespace grainsweep::tests {

/// Powder of the comparison: d = 45 um, density 4430, E 1e7, nu 0.3, e 0.6, mu 0.5, 5e-7 s (19 % of the Rayleigh time).
struct BedOptions {
    int per_side = 22;           ///< columns of the lattice along x and y
    int layers = 41;             ///< along z
    double spread = 0;           ///< radii within +-spread
    std::uint64_t seed = 5;      ///< of the jitter
    double settle_time = 10e-3;  ///< s, under gravity raised fivefold, and as long again under its own
};

/// A bed settled on a plane from a jittered lattice; what lies within 1.4 diameters of it then frozen and the plane
/// gone. Periodic in x, y.
[[nodiscard]] dem::Setup settled_bed(const BedOptions& options);
/// The same bed nx times ny side by side.
[[nodiscard]] dem::Setup replicated(const dem::Setup& bed, int nx, int ny);
/// The chute of that inclination after `time`, flowing.
[[nodiscard]] dem::Setup flowing(dem::Setup bed, double degrees, double time);
/// A chute of 2,000 spheres at 26 degrees, at rest; after small_chute_time it flows.
[[nodiscard]] dem::Setup small_chute(std::uint64_t seed);
inline constexpr double small_chute_time = 0.012;  // s
/// Gravity turned to a chute of this inclination, degrees, along x.
[[nodiscard]] dem::Setup tilted(dem::Setup bed, double degrees);
/// Mobile particles far apart and in motion, three-dimensional periodic.
[[nodiscard]] dem::Setup loose_gas(int per_side);

/// A drum of the experiment's size (radius 42 mm, length 20 mm) at 15 rpm with 29,185 spheres of 1.2 mm, mu 0.5, end
/// plates turning with it, after 0.25 s: the bed has slid once and flows.
[[nodiscard]] dem::Setup turning_drum();
/// The same drum as one closed mesh of 14,112 triangles of about 1.5 mm: 168 facets around, contacts with neighbouring
/// ones are one.
[[nodiscard]] dem::Setup of_triangles(dem::Setup turning_drum);

/// State of the comparison's other programs: int64 count, three doubles of box, then per particle x y z radius, v, w,
/// frozen as eleven doubles. Throws std::runtime_error where it cannot be read.
[[nodiscard]] dem::Setup read_bed(const std::filesystem::path& file);

/// The spreading scene at the start of settling: lattice between two gate planes, base plane, depth 10 D periodic.
[[nodiscard]] dem::Setup spreading_start(double diameter, double friction, std::uint64_t seed);
/// Base and blade of the sweep.
[[nodiscard]] std::vector<dem::Wall> spreading_blade(double gap, double speed);

}  // namespace grainsweep::tests
