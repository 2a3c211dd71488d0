// Accumulation: measures of the uneven distribution of particles in a box.
//
//   K = sum over cells |k_i - m| / (2 (N - m)),   m = N/cells
// (eq. 32 of Manayil Santhosh, Anwar & Lappa 2024, IAC-24-A1.2.3): it is 1 if all particles are in one cell. The
// smallest possible value is 0 only if m is whole. Independent uniform particles have binomial counts, p = 1/cells, so
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

/// Returns the particles per cell of an n x n x n sampling grid, x fastest; positions outside count in the nearest
/// cell.
[[nodiscard]] std::vector<int> cell_counts(std::span<const Vec3> positions, const Box& box, int n);

/// Returns K of counts; NaN for fewer than two particles.
[[nodiscard]] double accumulation(std::span<const int> counts);
/// Returns the expected K of N independent uniform particles on that number of cells.
[[nodiscard]] double random_accumulation(std::size_t particles, std::size_t cells);
/// Returns the standard deviation of this K over clouds, without the correlation of counts, which overestimates it.
[[nodiscard]] double random_accumulation_deviation(std::size_t particles, std::size_t cells);

/// Returns the particles in each of n slabs along axis d, divided by the mean: 1 everywhere for a uniform cloud.
[[nodiscard]] std::vector<double> density_profile(std::span<const Vec3> positions, const Box& box, int n, int d);

/// Counts groups of neighbouring cells (sharing a face) with more than twice the mean each. A group counts if it has at
/// least a twentieth of all particles: 0 for a random cloud, 2 for the two classical structures. NaN if twice the mean
/// is less than one particle, because every particle would make a dense cell.
[[nodiscard]] double structures(std::span<const int> counts, int n);

/// Returns the first time from which a series stays near its last value: within a tenth of its rise, or within 3
/// `scatter` if that is more. `scatter`: standard deviation between samples. NaN if the structure has not formed: the
/// rise is at most 5 `scatter`, or the time lies in the last tenth, as in a steady rise.
[[nodiscard]] double formation_time(std::span<const double> times, std::span<const double> values, double scatter);

}  // namespace grainsweep::observables
