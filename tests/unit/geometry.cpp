#include "solver/geometry/bar.hpp"
#include "solver/geometry/domain.hpp"
#include "solver/geometry/plane.hpp"
#include "stats/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace grainsweep;
using namespace grainsweep::geometry;

namespace {

/// Distance from the rounded bar by brute force: the least over many points of its outline.
double sampled_distance(const Bar& bar, double x, double z) {
    double least = 1e9;
    const double r = bar.edge_radius;
    const auto look = [&](double px, double pz) { least = std::min(least, std::hypot(x - px, z - pz)); };
    constexpr int n = 3000;
    for (int k = 0; k <= n; ++k) {
        const double u = static_cast<double>(k) / n;
        look(bar.rear + u * (bar.front - bar.rear), bar.top);
        look(bar.rear + r + u * (bar.front - bar.rear - 2 * r), bar.bottom);
        look(bar.front, bar.bottom + r + u * (bar.top - bar.bottom - r));
        look(bar.rear, bar.bottom + r + u * (bar.top - bar.bottom - r));
        const double a = u * std::numbers::pi / 2;
        look(bar.front - r + r * std::sin(a), bar.bottom + r - r * std::cos(a));
        look(bar.rear + r - r * std::sin(a), bar.bottom + r - r * std::cos(a));
    }
    return least;
}

bool inside(const Bar& bar, double x, double z) {
    if (x < bar.rear || x > bar.front || z < bar.bottom || z > bar.top) return false;
    const double r = bar.edge_radius;
    const double dx = std::max({bar.rear + r - x, x - (bar.front - r), 0.0});
    const double dz = std::max(bar.bottom + r - z, 0.0);
    return dx == 0 || dz == 0 || std::hypot(dx, dz) <= r;
}

}  // namespace

TEST(Bar, FindsTheClosestPointOfSharpAndRoundedEdges) {
    for (const double radius : {0.0, 0.7, 2.5}) {
        const Bar bar{.rear = -5, .front = 0, .bottom = 2, .top = 12, .edge_radius = radius};
        const stats::Stream random(7, 1);
        for (std::uint64_t k = 0; k < 150; ++k) {
            const double x = -9 + 14 * random.uniform(2 * k);
            const double z = -2 + 18 * random.uniform(2 * k + 1);
            const auto closest = bar.closest({x, 3.3, z});
            const double expected = sampled_distance(bar, x, z) * (inside(bar, x, z) ? -1 : 1);
            ASSERT_NEAR(closest.distance, expected, 2e-3) << x << " " << z << " radius " << radius;
            ASSERT_NEAR(norm(closest.normal), 1, 1e-14);
            ASSERT_EQ(closest.normal[1], 0);
            // One step along the normal is one step away from the surface.
            const Vec3 further = Vec3{x, 3.3, z} + 1e-6 * closest.normal;
            if (closest.distance > 1e-3) {
                ASSERT_NEAR(bar.closest(further).distance - closest.distance, 1e-6, 1e-11);
            }
        }
    }
}

TEST(Bar, IsContinuousAcrossItsRegions) {
    const Bar bar{.rear = -5, .front = 0, .bottom = 2, .top = 12, .edge_radius = 0.7};
    const auto on_circle = [&](int k) {
        const double a = k * 2 * std::numbers::pi / 4000;
        return bar.closest({-2.5 + 5.5 * std::cos(a), 0, 5 + 6 * std::sin(a)}).distance;
    };
    // A distance cannot change faster than the point moves: 6 x 2 pi / 4000 per step.
    for (int k = 0; k < 4000; ++k) ASSERT_LT(std::abs(on_circle(k + 1) - on_circle(k)), 0.0095) << k;
}

TEST(Plane, MeasuresAlongItsNormal) {
    const Plane plane{{0, 0, 1}, {0.6, 0, 0.8}};
    EXPECT_NEAR(plane.closest({3, 9, 5}).distance, 0.6 * 3 + 0.8 * 4, 1e-15);
}

TEST(Domain, WrapsIntoThePeriodAndSeesTheNearestImage) {
    const Domain domain{{0, -1, 0}, {2, 1, 4}, {true, true, false}};
    for (const double x : {-7.3, -0.1, 0.0, 1.999, 2.0, 11.5}) {
        const Vec3 p = Vec3{x, 0, 0} + domain.wrapping({x, 0, 0});
        EXPECT_GE(p[0], 0);
        EXPECT_LT(p[0], 2);
        EXPECT_NEAR(std::remainder(p[0] - x, 2.0), 0, 1e-12);
    }
    EXPECT_EQ(domain.wrapping({1, 0, 77}), Vec3{});
    const Vec3 d = domain.separation({0.1, -0.9, 1}, {1.9, 0.9, 3});
    EXPECT_NEAR(d[0], 0.2, 1e-15);
    EXPECT_NEAR(d[1], 0.2, 1e-15);
    EXPECT_NEAR(d[2], -2, 1e-15);
    EXPECT_FALSE(domain.outside({9, 9, 1}));
    EXPECT_TRUE(domain.outside({1, 0, 4.1}));
    EXPECT_TRUE(domain.outside({1, 0, std::nan("")}));
    EXPECT_EQ(domain.image_shifts()[13], Vec3{});
    EXPECT_EQ(domain.image_shifts()[14], (Vec3{2, 0, 0}));
}
