// Which contact with a surface goes on from which of the step before, for what friction remembers.
//
// A contact is a place on the sphere, known by its normal, and not a triangle: between two steps the normal of a
// contact turns by the distance moved over the radius. So pairs are formed by the least angle between normals, the
// least first, each contact at most once, up to largest_turn. On a flat square cut by a diagonal the normal stays, and
// the memory passes from one triangle to the other. Over a convex edge the normal turns step by step and the memory
// stays. In a concave edge the new contact starts empty beside the old one. Over a shallow concave edge that is passed
// within one step the memory continues, turned. From a floor to a wall it does not.
#pragma once

#include "solver/geometry/vector.hpp"

#include <cstdint>
#include <span>

namespace grainsweep::geometry {

/// Angle between the normals of one contact in two steps, rad: beyond, it is another contact.
inline constexpr double largest_turn = 0.5;

inline constexpr std::uint32_t no_contact = 0xFFFFFFFF;

/// from[k]: the one of `before` that now[k] goes on from, or no_contact. Normals are unit vectors in the frame of the
/// surface. A sphere has few contacts with it: the cost grows with the cube of their number.
void match_contacts(std::span<const Vec3> before, std::span<const Vec3> now, std::span<std::uint32_t> from);

/// The vector turned by the rotation that takes one unit vector to another one, not opposite, in their common plane.
[[nodiscard]] Vec3 turned(const Vec3& vector, const Vec3& from, const Vec3& to);

}  // namespace grainsweep::geometry
