// A loose filling of a vessel: spheres of a powder at rest, at random places, without contacts.
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/particles/random_addition.hpp"
#include "solver/particles/size_distribution.hpp"

#include <cstdint>
#include <string_view>
#include <vector>

namespace grainsweep::kit {

/// Random sequential addition jams at a solid fraction of 0.38 far from walls, and takes long before that.
inline constexpr double most_loose_fraction = 0.35;

/// Volume of the sphere of this diameter, m3.
[[nodiscard]] double sphere_volume(double diameter);

/// `count` spheres of diameter D times a draw of `sizes`. Pure: diameters and places follow from the seed. Throws
/// std::invalid_argument with `full` where the room does not hold them.
[[nodiscard]] std::vector<dem::Sphere> loose_filling(const particles::SizeDistribution& sizes, double diameter,
                                                     std::int64_t count, const particles::Room& room,
                                                     std::uint64_t seed, std::string_view full);

}  // namespace grainsweep::kit
