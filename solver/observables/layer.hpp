// Observables of a powder under and behind a blade.
//
// x is the blade's direction, y across, z up; lengths in m. The position of a particle is its centre, unless its
// surface is mentioned. Particles are counted, not cut by planes, as in the post-processing of LIGGGHTS and Wu (2020).
#pragma once

#include "solver/dem/engine.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <unordered_set>
#include <vector>

namespace grainsweep::observables {

/// Returns the volume of the spheres whose centres have from <= x < to, m3.
[[nodiscard]] double solid_volume(const dem::State& state, double from, double to);

/// Returns the volume of the part of a sphere about 0 below z, m3: pi (2/3 r^3 + r^2 t - t^3/3), t = z within +-r.
[[nodiscard]] double sphere_below(double z, double r);

/// Solid volume in patches of from <= x < to and one period in y, m3. Patches are nearly squares of `side`; a sphere
/// belongs to the patch of its centre; x fastest.
class Patches {
public:
    /// `width`: period in y, from 0. to > from, side > 0.
    Patches(double from, double to, double width, double side);

    /// Adds `sign` times the volumes of the spheres.
    void add(const dem::State& state, double sign = 1);
    /// Returns the base area of a patch, m2.
    [[nodiscard]] double area() const { return dx_ * dy_; }
    [[nodiscard]] std::size_t size() const { return along_ * across_; }
    /// Returns the standard deviation of the volumes of the patches, m3; NaN for fewer than four patches.
    [[nodiscard]] double deviation() const;

private:
    double from_, to_, width_, dx_ = 0, dy_ = 0;
    std::size_t along_ = 1, across_ = 1;
    std::map<std::size_t, double> volume_;  ///< of patches with a sphere, so not more than spheres
};

/// Relief: height of the uppermost sphere surface above the points of a square grid; 0 at points without a sphere. The
/// points fill from <= x < to and one period in y at a pitch of at most `pitch`.
class Relief {
public:
    /// `width`: in y, from 0; `repeats`: it is a period. to > from, pitch > 0.
    Relief(const dem::State& state, double from, double to, double width, double pitch, bool repeats = true);

    [[nodiscard]] std::span<const double> heights() const { return heights_; }
    /// Returns the root mean square deviation of the heights from their mean (Sq of ISO 25178-2), m. NaN for a large
    /// grid of which the spheres can cover less than half, because only its covered points are stored.
    [[nodiscard]] double roughness() const;
    /// Returns the share of points without a sphere.
    [[nodiscard]] double empty_share() const;

private:
    std::int64_t points_ = 0;
    std::vector<double> heights_;
    std::unordered_set<std::int64_t> covered_;  ///< used instead of heights_
};

/// Profile of v_x: sum and number in horizontal layers of equal thickness above `bottom`, for x in (from, to).
struct VelocityProfile {
    std::vector<double> sum;            ///< m/s
    std::vector<std::int64_t> samples;  ///< number of particles

    explicit VelocityProfile(std::size_t layers) : sum(layers, 0), samples(layers, 0) {}
    void add(const dem::State& state, double from, double to, double bottom, double thickness);
};

/// Returns the root mean square of the second differences v(k - 1) - 2 v(k) + v(k + 1) of a profile, for all k with
/// three values. It is 0 for a straight profile, and sqrt(6) times the noise for independent values; NaN if no three
/// neighbours have values.
[[nodiscard]] double unevenness(std::span<const double> profile);

}  // namespace grainsweep::observables
