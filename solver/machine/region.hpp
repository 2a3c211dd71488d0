// Region of space in which particles are filled in, fed, or measured.
//
// The depth of a point is positive inside the region and at most the distance to its surface. So a sphere of radius r
// lies in the region if the depth of its centre is at least r.
#pragma once

#include "solver/field.hpp"
#include "solver/geometry/bounds.hpp"
#include "solver/geometry/domain.hpp"
#include "solver/geometry/tpms.hpp"
#include "solver/geometry/vector.hpp"

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

namespace grainsweep::machine {

using geometry::Bounds;
using geometry::shared;
using geometry::Vec3;

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
/// A region that moves with a wall, as far as it does so along a direction.
struct MovingRegion {
    std::vector<Region> of;             ///< one, where it is at the start
    std::size_t wall = 0;               ///< by number
    std::optional<Vec3> along{};        ///< empty: whichever way the wall moves
    std::shared_ptr<const Vec3> moved;  ///< way of the wall at the moment, which a run states; null: none
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
/// A region and its images across the periodic faces of a domain.
struct ImagesRegion {
    std::vector<Region> of;  ///< one
    geometry::Domain domain;
};

struct Region {
    using Box = BoxRegion;
    using Round = RoundRegion;
    using Ball = BallRegion;
    using Half = HalfRegion;
    using LevelSet = LevelSetRegion;
    using Moving = MovingRegion;
    using All = AllRegions;
    using Any = AnyRegion;
    using Not = NotRegion;
    using Images = ImagesRegion;
    std::variant<Box, Round, Ball, Half, LevelSet, Moving, All, Any, Not, Images> is;

    /// Returns the depth of a point, m.
    [[nodiscard]] double depth(const Vec3& x) const;
    /// Returns whether depth(x) is at least 0. For many points at one moment take a RegionNow.
    [[nodiscard]] bool contains(const Vec3& x) const;
    /// Returns a box around the region; infinite where the region is infinite.
    [[nodiscard]] Bounds bounds() const;
    /// Returns its volume, m3; empty for half spaces, level sets, combinations, and where images overlap.
    [[nodiscard]] std::optional<double> volume() const;
    /// Calls visit for each moving region in it.
    void each_moving(const std::function<void(Moving&)>& visit);
    /// Returns the error of its numbers, in one sentence; empty: none.
    [[nodiscard]] const char* flaw() const;
};

/// Calls visit(part) for the regions that a region is made of.
template <class R, class Visit>
void each_part(R& region, Visit&& visit) {
    std::visit(
        [&](auto& made) {
            if constexpr (requires { made.of; })
                for (auto& part : made.of) visit(part);
        },
        region.is);
}

/// Region at one moment; the region must outlive it. Answers as contains() does, for boxes and half spaces, moving or
/// not, in a few comparisons.
class RegionNow {
public:
    explicit RegionNow(const Region& region);
    [[nodiscard]] bool contains(Vec3 x) const {
        for (const Vec3& moved : moved_)  // 0 where nothing moves
            for (std::size_t a = 0; a < 3; ++a) x[a] -= moved[a];
        if (half_ != nullptr) return geometry::dot(geometry::operator-(x, half_->point), half_->normal) >= 0;
        if (box_ == nullptr) return still_->depth(x) >= 0;
        bool within = true;  // without jumps
        for (std::size_t a = 0; a < 3; ++a) within = within & (x[a] >= box_->low[a]) & (x[a] <= box_->high[a]);
        return within;
    }

private:
    std::array<Vec3, 2> moved_{};
    const Region* still_;
    const BoxRegion* box_;
    const HalfRegion* half_;
};
/// Returns a region at this moment, if there is one.
[[nodiscard]] inline std::optional<RegionNow> now(const std::optional<Region>& region) {
    return region ? std::optional<RegionNow>(*region) : std::nullopt;
}

/// Returns the region with its images where it reaches beyond a periodic face of the domain. A box or an upright
/// cylinder that is longer than a period ends at the faces. Of other regions longer than four periods only the five
/// images nearest to the middle count, which is exact unless the region is hollow there.
[[nodiscard]] Region with_images(Region region, const geometry::Domain& domain);
/// Returns the same for bodies that reach over a periodic face: a region within the faces has images too, and one that
/// is longer than a period has no ends.
[[nodiscard]] Region with_images_for_bodies(Region region, const geometry::Domain& domain);

/// Returns the alternatives of Region::is with the fields that a file sets. Combinations have none: they are made of
/// regions.
[[nodiscard]] std::span<const Type> region_types();
[[nodiscard]] std::span<const Field> level_set_fields();

}  // namespace grainsweep::machine
