// Random close packings of equal spheres in a periodic cube.
//
// N points fall uniformly into the cube; the harmonic overlap energy E = sum_{r < 1} (1 - r)^2 / 2 over the
// nearest images (lengths in diameters) is then minimised by FIRE (Bitzek, Koskinen, Gaehler, Moseler &
// Gumbsch, Phys. Rev. Lett. 97, 170201, 2006) until no pair overlaps by more than the tolerance. Below random
// close packing (about 0.64) that state exists and is free of force: neighbours just touch, nothing is loaded.
//
// Positions are 32-bit fixed-point numbers, one turn of the integer per edge: differences are exact and
// wrap to the nearest image by themselves; one step of the grid is edge/2^32 (2.3e-8 diameters at edge 100).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::particles {

struct PackingRequest {
    double edge = 20;         ///< of the cube, diameters; 5 to 400
    double fraction = 0.62;   ///< wanted volume fraction, 0.05 to 0.635; what fits in whole spheres is exact
    std::uint64_t seed = 1;   ///< of the first points
    double tolerance = 2e-5;  ///< largest overlap left, diameters; at least 5e-6
};

struct Packing {
    double edge = 0;                               ///< diameters
    std::vector<std::array<double, 3>> positions;  ///< diameters, in [0, edge)
    double largest_overlap = 0;                    ///< diameters, over nearest images
    int iterations = 0;                            ///< of the minimiser
};

/// Number of spheres: round(6 fraction edge^3 / pi).
[[nodiscard]] std::int64_t sphere_count(const PackingRequest& request);

/// The packing of a request: a pure function of it, the same bits on every processor.
/// Throws std::invalid_argument on a request out of range and when the tolerance is not reached.
[[nodiscard]] Packing random_close_packing(const PackingRequest& request);

/// Canonical text of what determines the packing, with the revision of the algorithm.
[[nodiscard]] std::string packing_key(const PackingRequest& request);

/// A packing as bytes and back, bit for bit. decode throws std::invalid_argument on anything else.
[[nodiscard]] std::vector<std::byte> encode(const Packing& packing);
[[nodiscard]] Packing decode_packing(std::span<const std::byte> bytes);

/// Reads text with the header x,y,z and one centre a line, diameters, in [0, edge]. Overlaps are measured
/// between the points as they are (no images). Throws std::invalid_argument naming the line that is wrong.
[[nodiscard]] Packing read_packing(std::string_view csv, double edge);

}  // namespace grainsweep::particles
