// Random sequential addition: spheres placed one after another at uniformly random places where they overlap none of
// those before, the largest first (Widom 1966, doi 10.1063/1.1726548; equal spheres jam at a fraction of 0.38).
//
// A loose start for spheres of any mixture of sizes, without segregation and as low as the fraction allows; a lattice
// would have to be as wide as the largest sphere everywhere.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace grainsweep::particles {

/// A box in which whole spheres must lie along x and z, and which is periodic along y.
struct Tray {
    std::array<double, 3> low{}, high{};
};

/// Centres, in the order of `radii`. A sphere's tries are drawn from (seed, its index): pure and the same everywhere.
/// Throws std::invalid_argument where a sphere fits nowhere in a hundred thousand tries or is wider than half the
/// period.
[[nodiscard]] std::vector<std::array<double, 3>> random_addition(const Tray& tray, std::span<const double> radii,
                                                                 std::uint64_t seed);

/// A vessel within a box; along periodic axes the box repeats itself.
struct Room {
    std::array<double, 3> low{}, high{};
    std::array<bool, 3> periodic{};
    /// Whether a whole sphere lies in the vessel, of those that lie in the box; empty: they all do.
    std::function<bool(const std::array<double, 3>& centre, double radius)> holds;
};

/// The same in a vessel; nothing where a sphere fits nowhere in a hundred thousand tries. Throws std::invalid_argument
/// where a sphere is wider than half a period.
[[nodiscard]] std::optional<std::vector<std::array<double, 3>>> random_addition(const Room& room,
                                                                                std::span<const double> radii,
                                                                                std::uint64_t seed);

}  // namespace grainsweep::particles
