// Comparison of directions and lines, up to the rounding of their numbers.
#pragma once

#include "solver/geometry/vector.hpp"

namespace grainsweep::geometry {

inline constexpr double alignment_rounding = 1e-12;

[[nodiscard]] inline bool is_unit(const Vec3& a) {
    return std::abs(norm(a) - 1) < alignment_rounding;
}
[[nodiscard]] inline bool parallel(const Vec3& unit, const Vec3& direction) {
    return norm(cross(unit, direction)) <= alignment_rounding * norm(direction);
}
[[nodiscard]] inline bool perpendicular(const Vec3& unit, const Vec3& direction) {
    return std::abs(dot(unit, direction)) <= alignment_rounding * norm(direction);
}
/// Returns whether `point` lies on the line through `on` along `unit`, relative to a length of the case.
[[nodiscard]] inline bool on_line(const Vec3& point, const Vec3& on, const Vec3& unit, double length) {
    return norm(cross(point - on, unit)) <= alignment_rounding * length;
}

}  // namespace grainsweep::geometry
