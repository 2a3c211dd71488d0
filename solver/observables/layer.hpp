// What is measured of a powder under and behind a blade: pure functions of a state.
//
// x is the blade's direction, y across, z up; lengths in m. A particle is where its centre is, unless its surface is
// meant. Counting, not averaging over volumes cut by planes: what LIGGGHTS post-processing and Wu (2020) do.
#pragma once

#include "solver/dem/engine.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <unordered_set>
#include <vector>

namespace grainsweep::observables {

/// Sum of what the particles with centres at x < front carry; `carried` by id, all 1 to count them.
[[nodiscard]] double sum_behind(const dem::State& state, std::span<const double> carried, double front);

/// The same over the centres with rear <= x < front and z <= height.
[[nodiscard]] double sum_under(const dem::State& state, std::span<const double> carried, double rear, double front,
                               double height);

/// Volume of the spheres whose centres have from <= x < to, m3.
[[nodiscard]] double solid_volume(const dem::State& state, double from, double to);

/// The same of those with low < z <= high, too.
[[nodiscard]] double solid_volume(const dem::State& state, double from, double to, double low, double high);

/// Volume of the parts of the spheres with low <= z <= high, over the centres with from <= x < to, m3. Spheres are cut
/// by the planes: below z lies 2/3 r^3 + r^2 t - t^3/3 times pi of a sphere, t = z - z_centre within +-r.
[[nodiscard]] double solid_between(const dem::State& state, double from, double to, double low, double high);

/// Solid volume by patches of from <= x < to and one period in y, as near to squares of `side` as they divide it;
/// by centres, x fastest, m3.
class Patches {
public:
    /// Periodic in y with period `width` from 0. to > from, side > 0.
    Patches(double from, double to, double width, double side);

    /// Adds `sign` times the volumes of the spheres.
    void add(const dem::State& state, double sign = 1);
    /// Base area of one of them, m2.
    [[nodiscard]] double area() const { return dx_ * dy_; }
    [[nodiscard]] std::size_t size() const { return along_ * across_; }
    /// Standard deviation of their volumes, m3; of fewer than four NaN.
    [[nodiscard]] double deviation() const;

private:
    double from_, to_, width_, dx_ = 0, dy_ = 0;
    std::size_t along_ = 1, across_ = 1;
    std::map<std::size_t, double> volume_;  ///< of patches with a sphere: as many as there are spheres at most
};

/// Height of the uppermost sphere surface above the points of a square grid, seen from above; 0 where no sphere covers
/// the point. The points fill from <= x < to and one period in y at a pitch of at most `pitch`.
class Relief {
public:
    /// Periodic in y with period `width` from 0. to > from, pitch > 0.
    Relief(const dem::State& state, double from, double to, double width, double pitch);

    [[nodiscard]] std::span<const double> heights() const { return heights_; }
    /// Root mean square deviation of the heights from their mean (Sq of ISO 25178-2), m; NaN for a large grid of
    /// which the spheres can cover less than half: of that only the covered points are kept.
    [[nodiscard]] double roughness() const;
    /// Share of points no sphere covers.
    [[nodiscard]] double empty_share() const;

private:
    std::int64_t points_ = 0;
    std::vector<double> heights_;
    std::unordered_set<std::int64_t> covered_;  ///< where there are no heights_
};

/// Sum and number of v_x in horizontal layers of equal thickness above `bottom`, over x in (from, to).
struct VelocityProfile {
    std::vector<double> sum;            ///< m/s
    std::vector<std::int64_t> samples;  ///< particles seen

    explicit VelocityProfile(std::size_t layers) : sum(layers, 0), samples(layers, 0) {}
    void add(const dem::State& state, double from, double to, double bottom, double thickness);
};

/// Returns the root mean square of the second differences v(k - 1) - 2 v(k) + v(k + 1) of a profile, where all three
/// values exist (NaN: nowhere). It is 0 for a straight profile, sqrt(6) times the noise of independent values; NaN
/// where no three neighbours have values.
[[nodiscard]] double unevenness(std::span<const double> profile);

/// Standard error of the mean of a correlated series from the spread of `blocks` means of consecutive, equally long
/// blocks (batch means); NaN where the series is shorter than two per block. What does not fill a block is left out.
[[nodiscard]] double block_standard_error(std::span<const double> series, std::size_t blocks);

}  // namespace grainsweep::observables
