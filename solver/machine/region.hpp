// Region of space in which particles are filled in, fed, or measured.
//
// The depth of a point is positive inside the region and at most the distance to its surface. So a sphere of radius r
// lies in the region if the depth of its centre is at least r.
#pragma once

#include "solver/field.hpp"
#include "solver/geometry/vector.hpp"

#include <optional>
#include <variant>
#include <vector>

namespace grainsweep::machine {

using geometry::Vec3;

struct Bounds {
    Vec3 low{}, high{};
};

struct Region;

struct BoxRegion {
    Vec3 low{}, high{};
};
/// Solid or hollow cylinder between two planes across its axis.
struct RoundRegion {
    Vec3 base{};         ///< centre of the first end
    Vec3 axis{0, 0, 1};  ///< unit
    double radius = 0;   ///< m
    double inner = 0;    ///< m
    double length = 0;   ///< m
};
struct BallRegion {
    Vec3 centre{};
    double radius = 0;
};
/// Half space on the side to which the plane's normal points.
struct HalfRegion {
    Vec3 point{};
    Vec3 normal{0, 0, 1};  ///< unit
};
struct AllRegions {
    std::vector<Region> of;
};
struct AnyRegion {
    std::vector<Region> of;
};
/// Complement of a region.
struct NotRegion {
    std::vector<Region> of;
};

struct Region {
    using Box = BoxRegion;
    using Round = RoundRegion;
    using Ball = BallRegion;
    using Half = HalfRegion;
    using All = AllRegions;
    using Any = AnyRegion;
    using Not = NotRegion;
    std::variant<Box, Round, Ball, Half, All, Any, Not> is;

    /// Returns the depth of a point, m.
    [[nodiscard]] double depth(const Vec3& x) const;
    [[nodiscard]] bool contains(const Vec3& x) const { return depth(x) >= 0; }
    /// Returns a box around the region; infinite where the region is infinite.
    [[nodiscard]] Bounds bounds() const;
    /// Returns its volume, m3; empty for half spaces and combinations.
    [[nodiscard]] std::optional<double> volume() const;
    /// Returns the error of its numbers, in one sentence; empty: none.
    [[nodiscard]] const char* flaw() const;
};

/// Returns the alternatives of Region::is with the fields that a file sets. Combinations have none: they are made of
/// regions.
[[nodiscard]] std::span<const Type> region_types();

}  // namespace grainsweep::machine
