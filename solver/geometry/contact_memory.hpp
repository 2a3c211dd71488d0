// Matching of contacts with a surface between two steps, for the memory of friction.
//
// A contact is identified by its normal, not by its triangle. Between two steps the normal of a contact rotates by the
// distance moved divided by the radius. So contacts are matched by the angle between normals, the smallest angle first,
// each contact at most once, up to largest_turn. Examples:
//
//   flat square of two triangles   the normal stays, and the memory moves to the other triangle
//   convex edge                    the normal rotates step by step, and the memory continues
//   concave edge                   the new contact starts without memory beside the old one
//   shallow concave edge           if it is passed within one step, the memory continues, rotated
//   floor to wall                  the memory does not continue
#pragma once

#include "solver/geometry/vector.hpp"

#include <cstdint>
#include <span>

namespace grainsweep::geometry {

/// Largest angle between the normals of one contact in two steps, rad.
inline constexpr double largest_turn = 0.5;

inline constexpr std::uint32_t no_contact = 0xFFFFFFFF;

/// Sets from[k] to the index in `before` of the contact that now[k] continues, or to no_contact. Normals are unit
/// vectors in the frame of the surface. The cost grows with the cube of the number of contacts, which is small.
void match_contacts(std::span<const Vec3> before, std::span<const Vec3> now, std::span<std::uint32_t> from);

/// Returns the vector rotated by the rotation, in their common plane, from one unit vector to another that is not
/// opposite.
[[nodiscard]] Vec3 turned(const Vec3& vector, const Vec3& from, const Vec3& to);

}  // namespace grainsweep::geometry
