// A loose filling of a vessel: spheres of a powder without contacts, at random places or on a lattice.
//
// What falls far packs more densely, by 3 % in a tube filled at random at a solid fraction of 0.22 instead of on a
// lattice, and the heap that it makes shows it.
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/particles/random_addition.hpp"
#include "solver/particles/size_distribution.hpp"

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace grainsweep::kit {

/// Random sequential addition jams at a solid fraction of 0.38 far from walls, and takes long before that.
inline constexpr double most_loose_fraction = 0.35;

/// `count` spheres of diameter D times a draw of `sizes`. Pure: diameters and places follow from the seed. Throws
/// std::invalid_argument with `full` where the room does not hold them.
[[nodiscard]] std::vector<dem::Sphere> loose_filling(const particles::SizeDistribution& sizes, double diameter,
                                                     std::int64_t count, const particles::Room& room,
                                                     std::uint64_t seed, std::string_view full);

/// A cubic lattice of spacing 1.15 D in an upright round vessel about z; places are off it by up to 0.05 D per
/// coordinate, less where sizes differ, so that none touch.
class TubeLattice {
public:
    /// For `count` spheres; `largest`: diameter of the largest, m.
    TubeLattice(double radius, double diameter, double largest, std::int64_t count);

    /// Of the spheres over the floor, m; infinite where the lattice is not for them: spheres wider than the spacing, a
    /// tube too narrow for one, or so wide that they fill less than a layer.
    [[nodiscard]] double height() const;
    /// From the floor up, with random velocities of up to `speed` per component. Pure.
    [[nodiscard]] std::vector<dem::Sphere> filled(const particles::SizeDistribution& sizes, double floor, double speed,
                                                  std::uint64_t seed) const;

private:
    std::int64_t count_;
    double diameter_, jitter_;
    std::vector<std::array<double, 2>> sites_;  ///< of a layer
};

}  // namespace grainsweep::kit
