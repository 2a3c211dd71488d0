// How unevenly particles fill a box.
//
//   K = sum over cells |k_i - m| / (2 (N - m)),   m = N/cells
// (eq. 32 of Manayil Santhosh, Anwar & Lappa 2024, IAC-24-A1.2.3): 1 when all particles share one cell. The least
// possible value is 0 only if m is whole. Independent uniform particles have binomial counts, p = 1/cells, so
//   K_random = cells E|k - m| / (2 (N - m)),   E|k - m| = 2 f C(N, f) p^f (1 - p)^(N - f + 1),  f = floor(m) + 1
// (De Moivre's mean deviation; Diaconis & Zabell 1991, doi 10.1214/ss/1177011699),
// so the excess (K - K_random)/(1 - K_random) is 0 for a random cloud and 1 for a point.
#pragma once

#include <array>
#include <span>
#include <vector>

namespace grainsweep::observables {

using Vec3 = std::array<double, 3>;

struct Box {
    Vec3 low{}, high{};
};

/// Particles per cell of an n x n x n sampling grid, x fastest; positions outside count in the nearest cell.
[[nodiscard]] std::vector<int> cell_counts(std::span<const Vec3> positions, const Box& box, int n);

/// K of counts; NaN for fewer than two particles.
[[nodiscard]] double accumulation(std::span<const int> counts);
/// Returns the expected K of N independent uniform particles on that number of cells.
[[nodiscard]] double random_accumulation(std::size_t particles, std::size_t cells);
/// Standard deviation of that K over clouds with the correlation of counts neglected, which overestimates it.
[[nodiscard]] double random_accumulation_deviation(std::size_t particles, std::size_t cells);
/// Returns the least K that N particles can have on that number of cells.
[[nodiscard]] double least_accumulation(std::size_t particles, std::size_t cells);

/// Particles in each of n slabs along axis d over the mean: 1 everywhere for a uniform cloud.
[[nodiscard]] std::vector<double> density_profile(std::span<const Vec3> positions, const Box& box, int n, int d);

/// Counts groups of neighbouring cells (sharing a face) with more than twice the mean each. A group counts if it holds
/// at least a twentieth of all particles: 0 for a random cloud, 2 for the two classical structures. NaN where
/// twice the mean is less than one particle: every particle would be a dense cell.
[[nodiscard]] double structures(std::span<const int> counts, int n);

/// Returns the first time from which a series stays near its last value: within a tenth of its rise, or within 3
/// `scatter`, its standard deviation from sample to sample, where that is more. NaN where the rise is no more than 5
/// `scatter`, and where that time lies in the last tenth of all, as that of a steady rise does: not formed yet.
[[nodiscard]] double formation_time(std::span<const double> times, std::span<const double> values, double scatter);

}  // namespace grainsweep::observables
