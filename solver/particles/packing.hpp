// Random close packings of equal spheres in a periodic cube.
//
// N points are uniformly random in the cube. FIRE (Bitzek, Koskinen, Gaehler, Moseler & Gumbsch, Phys. Rev. Lett. 97,
// 170201, 2006) then minimises the harmonic overlap energy E = sum_{r < 1} (1 - r)^2 / 2 over nearest images (lengths
// in diameters), until no overlap exceeds the tolerance. Below random close packing (about 0.64) this state exists and
// is free of force: neighbours just touch.
//
// Positions are 32-bit fixed-point numbers with 2^32 units per edge, so differences are exact and wrap to the nearest
// image. The unit is edge/2^32 (2.3e-8 diameters at edge 100).
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
    double fraction = 0.62;   ///< wanted volume fraction, 0.05 to 0.635, up to the rounding to whole spheres
    std::uint64_t seed = 1;   ///< of the first points
    double tolerance = 2e-5;  ///< largest overlap left, diameters; at least 5e-6
};

struct Packing {
    double edge = 0;                               ///< diameters
    std::vector<std::array<double, 3>> positions;  ///< diameters, in [0, edge)
    double largest_overlap = 0;                    ///< diameters, over nearest images
    int iterations = 0;                            ///< of the minimiser
};

/// Returns the number of spheres: round(6 fraction edge^3 / pi).
[[nodiscard]] std::int64_t sphere_count(const PackingRequest& request);

/// Returns the packing of a request, with the same bits on every processor. Throws std::invalid_argument if the request
/// is out of range or the tolerance is not reached.
[[nodiscard]] Packing random_close_packing(const PackingRequest& request);

/// Returns a canonical text of the data that determine the packing, with the revision of the algorithm.
[[nodiscard]] std::string packing_key(const PackingRequest& request);

/// Convert a packing to bytes and back with all bits. decode throws std::invalid_argument for other bytes.
[[nodiscard]] std::vector<std::byte> encode(const Packing& packing);
[[nodiscard]] Packing decode_packing(std::span<const std::byte> bytes);

/// Reads text with the header x,y,z and one centre per line, in diameters, in [0, edge]. Overlaps are measured without
/// images. Throws std::invalid_argument with the number of an invalid line.
[[nodiscard]] Packing read_packing(std::string_view csv, double edge);

}  // namespace grainsweep::particles
