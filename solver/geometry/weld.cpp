#include "solver/geometry/weld.hpp"

#include "solver/geometry/bounds.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <unordered_map>

namespace grainsweep::geometry {
namespace {

using CellIndex = std::array<std::int64_t, 3>;

struct CellHash {
    std::size_t operator()(const CellIndex& cell) const {
        std::uint64_t h = 0;
        for (const std::int64_t k : cell) h = (h ^ static_cast<std::uint64_t>(k)) * 0x9E3779B97F4A7C15ULL;
        return static_cast<std::size_t>(h ^ (h >> 29U));
    }
};

/// Sets of points in which each is near another one; the first of a set stands for it.
class Sets {
public:
    explicit Sets(std::size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
    std::size_t first_of(std::size_t k) {
        while (parent_[k] != k) k = parent_[k] = parent_[parent_[k]];
        return k;
    }
    void join(std::size_t a, std::size_t b) {
        a = first_of(a);
        b = first_of(b);
        parent_[std::max(a, b)] = std::min(a, b);
    }

private:
    std::vector<std::size_t> parent_;
};

/// Points nearer than `tolerance`, among points that are all different.
Sets near_sets(const std::vector<Vec3>& points, double tolerance) {
    Sets sets(points.size());
    if (!(tolerance > 0)) return sets;
    std::unordered_map<CellIndex, std::vector<std::size_t>, CellHash> cells;
    const auto cell_of = [&](const Vec3& x) {
        CellIndex cell{};
        for (std::size_t k = 0; k < 3; ++k)
            cell[k] = static_cast<std::int64_t>(std::floor((x[k] - points.front()[k]) / tolerance));
        return cell;
    };
    for (std::size_t p = 0; p < points.size(); ++p) {
        const CellIndex home = cell_of(points[p]);
        for (std::int64_t n = 0; n < 27; ++n) {
            const auto there = cells.find({home[0] + n % 3 - 1, home[1] + n / 3 % 3 - 1, home[2] + n / 9 - 1});
            if (there == cells.end()) continue;
            for (const std::size_t q : there->second) {
                const Vec3 apart = points[p] - points[q];
                if (dot(apart, apart) < tolerance * tolerance) sets.join(p, q);
            }
        }
        cells[home].push_back(p);
    }
    return sets;
}

double height(const std::array<Vec3, 3>& corner) {
    double longest2 = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3 side = corner[(k + 1) % 3] - corner[k];
        longest2 = std::max(longest2, dot(side, side));
    }
    return longest2 > 0 ? norm(cross(corner[1] - corner[0], corner[2] - corner[0])) / std::sqrt(longest2) : 0;
}

}  // namespace

WeldedSurface weld(const std::vector<std::array<Vec3, 3>>& triangles) {
    std::vector<Vec3> points;
    points.reserve(3 * triangles.size());
    const auto plain_zero = [](Vec3 x) {
        for (double& c : x) c += 0.0;  // -0 equals 0
        return x;
    };
    for (const auto& triangle : triangles)
        for (const Vec3& corner : triangle) points.push_back(plain_zero(corner));
    std::ranges::sort(points);
    points.erase(std::unique(points.begin(), points.end()), points.end());

    WeldedSurface welded;
    if (points.empty()) return welded;
    const auto [low, high] = bounds_around(points);
    const double tolerance = weld_tolerance * norm(high - low);
    Sets sets = near_sets(points, tolerance);

    std::vector<std::array<std::size_t, 3>> kept;
    std::vector<std::int32_t> number(points.size(), -1);
    for (std::size_t p = 0; p < points.size(); ++p) welded.merged += sets.first_of(p) != p ? 1U : 0U;
    for (const auto& triangle : triangles) {
        std::array<std::size_t, 3> at{};
        std::array<Vec3, 3> corner{};
        for (std::size_t k = 0; k < 3; ++k) {
            const auto found = std::ranges::lower_bound(points, plain_zero(triangle[k]));
            at[k] = sets.first_of(static_cast<std::size_t>(found - points.begin()));
            corner[k] = points[at[k]];
        }
        if (height(corner) <= tolerance) {
            ++welded.dropped;
            continue;
        }
        kept.push_back(at);
        for (const std::size_t k : at) number[k] = 0;
    }
    for (std::size_t p = 0; p < points.size(); ++p) {
        if (number[p] < 0) continue;
        number[p] = static_cast<std::int32_t>(welded.surface.corners.size());
        welded.surface.corners.push_back(points[p]);
    }
    for (const auto& at : kept) welded.surface.triangles.push_back({number[at[0]], number[at[1]], number[at[2]]});
    return welded;
}

}  // namespace grainsweep::geometry
