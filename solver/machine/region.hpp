// Region of space in which particles are filled in, fed, or measured.
//
// The depth of a point is positive inside the region and at most the distance to its surface. So a sphere of radius r
// lies in the region if the depth of its centre is at least r.
#pragma once

#include "solver/field.hpp"
#include "solver/geometry/tpms.hpp"
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
/// Shell around a triply periodic minimal surface f = 0 (geometry/tpms.hpp), or the space on one side of the shell.
struct LevelSetRegion {
    geometry::TpmsCell cell = geometry::TpmsCell::schwarz_p;
    double edge = 0;   ///< of a cubic cell, m
    double shell = 0;  ///< largest thickness of the shell, m
    double side = 0;   ///< 0: the shell; +1 or -1: where f has this sign, outside the shell
    Vec3 at{};         ///< lowest corner of a cell

    /// Returns the diameter of the largest disc of the region in the lower face of a cell, with its centre in the face,
    /// m; 0 if the face is closed. The error is below edge/256. Remembers it, because it takes milliseconds.
    [[nodiscard]] double opening() const;
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
    using LevelSet = LevelSetRegion;
    using All = AllRegions;
    using Any = AnyRegion;
    using Not = NotRegion;
    std::variant<Box, Round, Ball, Half, LevelSet, All, Any, Not> is;

    /// Returns the depth of a point, m.
    [[nodiscard]] double depth(const Vec3& x) const;
    [[nodiscard]] bool contains(const Vec3& x) const {
        const auto* box = std::get_if<Box>(&is);
        if (box == nullptr) return depth(x) >= 0;
        const auto along = [&](std::size_t k) { return x[k] >= box->low[k] && x[k] <= box->high[k]; };
        return along(0) && along(1) && along(2);
    }
    /// Returns a box around the region; infinite where the region is infinite.
    [[nodiscard]] Bounds bounds() const;
    /// Returns its volume, m3; empty for half spaces, level sets and combinations.
    [[nodiscard]] std::optional<double> volume() const;
    /// Returns the error of its numbers, in one sentence; empty: none.
    [[nodiscard]] const char* flaw() const;
};

/// Returns the alternatives of Region::is with the fields that a file sets. Combinations have none: they are made of
/// regions.
[[nodiscard]] std::span<const Type> region_types();
[[nodiscard]] std::span<const Field> level_set_fields();

}  // namespace grainsweep::machine
