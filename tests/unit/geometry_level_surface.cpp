// Triangles of a level set: where they lie, that they close, and how large they are.
#include "solver/geometry/level_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "solver/machine/region.hpp"

namespace grainsweep::tests::geometry_level_surface_test {

using namespace geometry;

double area(const TriangleSurface& surface) {
    double sum = 0;
    for (const auto& [a, b, c] : surface.triangles) {
        const auto& x = surface.corners[static_cast<std::size_t>(a)];
        sum += 0.5 * norm(cross(surface.corners[static_cast<std::size_t>(b)] - x,
                                surface.corners[static_cast<std::size_t>(c)] - x));
    }
    return sum;
}

TriangleSurface sphere(int cells) {
    return level_surface([](const Vec3& x) { return norm(x) - 0.4; }, {-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, cells);
}

TEST(LevelSurface, OfASphereIsClosedAndLooksOutwards) {
    const auto surface = sphere(24);
    std::map<std::pair<std::int32_t, std::int32_t>, int> sides;
    for (const auto& t : surface.triangles) {
        const auto at = [&](int k) {
            return surface.corners[static_cast<std::size_t>(t[static_cast<std::size_t>(k)])];
        };
        EXPECT_GE(dot(cross(at(1) - at(0), at(2) - at(0)), at(0)), 0);
        for (std::size_t k = 0; k < 3; ++k) ++sides[{t[k], t[(k + 1) % 3]}];
    }
    for (const auto& [side, times] : sides) {
        EXPECT_EQ(times, 1);
        EXPECT_EQ(sides.count({side.second, side.first}), 1U);
    }
    // Euler: V - E + F = 2.
    EXPECT_EQ(surface.corners.size() - sides.size() / 2 + surface.triangles.size(), 2U);
}

TEST(LevelSurface, ConvergesWithTheSquareOfTheGrid) {
    const double exact = 4 * std::numbers::pi * 0.16;
    const double coarse = std::abs(area(sphere(16)) - exact), fine = std::abs(area(sphere(32)) - exact);
    EXPECT_LT(coarse, 0.02 * exact);
    EXPECT_GT(coarse / fine, 3);
    double farthest = 0;
    for (const auto& x : sphere(32).corners) farthest = std::max(farthest, std::abs(norm(x) - 0.4));
    EXPECT_LT(farthest, 1.0 / 32 / 32);
}

// Areas of the minimal surfaces in the unit cell: P 2.3451, G 3.0915, D 3.8377 (doubled cell); the level sets are
// within a percent of them.
TEST(LevelSurface, OfTpmsCellsHasTheirAreaAndEndsOnTheFaces) {
    const std::map<TpmsCell, double> areas = {
        {TpmsCell::schwarz_p, 2.3451}, {TpmsCell::gyroid, 3.0915}, {TpmsCell::diamond, 3.8377}};
    for (const auto& [cell, exact] : areas) {
        const machine::Region kept{machine::LevelSetRegion{cell, 20, 0, 1}};
        const auto surface = level_surface([&](const Vec3& x) { return kept.depth(x); }, {}, {20, 20, 20}, 36);
        EXPECT_NEAR(area(surface) / 400, exact, 0.015 * exact) << traits(cell).name;
        std::map<std::pair<std::int32_t, std::int32_t>, int> sides;
        for (const auto& t : surface.triangles)
            for (std::size_t k = 0; k < 3; ++k) ++sides[std::minmax(t[k], t[(k + 1) % 3])];
        for (const auto& [side, times] : sides) {
            if (times % 2 == 0) continue;  // four where two sheets share a corner
            const auto& a = surface.corners[static_cast<std::size_t>(side.first)];
            const auto& b = surface.corners[static_cast<std::size_t>(side.second)];
            bool on_a_face = false;
            for (std::size_t k = 0; k < 3; ++k) on_a_face = on_a_face || (a[k] == b[k] && (a[k] == 0 || a[k] == 20));
            EXPECT_TRUE(on_a_face) << traits(cell).name;
        }
    }
}

}  // namespace grainsweep::tests::geometry_level_surface_test
