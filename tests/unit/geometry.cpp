#include "solver/geometry/bar.hpp"
#include "solver/geometry/cone.hpp"
#include "solver/geometry/cylinder.hpp"
#include "solver/geometry/domain.hpp"
#include "solver/geometry/motion.hpp"
#include "solver/geometry/plane.hpp"
#include "solver/geometry/tube.hpp"
#include "stats/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grainsweep::tests::geometry_test {

using namespace geometry;

/// Distance from the rounded bar by brute force: the least over many points of its outline.
double sampled_distance(const Bar& bar, double x, double z) {
    double least = 1e9;
    const double r = bar.edge_radius;
    const auto look = [&](double px, double pz) { least = std::min(least, std::hypot(x - px, z - pz)); };
    constexpr int n = 3000;
    for (int k = 0; k <= n; ++k) {
        const double u = static_cast<double>(k) / n;
        look(bar.rear() + u * (bar.front - bar.rear()), bar.top);
        look(bar.rear() + r + u * (bar.front - bar.rear() - 2 * r), bar.bottom);
        look(bar.front, bar.bottom + r + u * (bar.top - bar.bottom - r));
        look(bar.rear(), bar.bottom + r + u * (bar.top - bar.bottom - r));
        const double a = u * std::numbers::pi / 2;
        look(bar.front - r + r * std::sin(a), bar.bottom + r - r * std::cos(a));
        look(bar.rear() + r - r * std::sin(a), bar.bottom + r - r * std::cos(a));
    }
    return least;
}

bool inside(const Bar& bar, double x, double z) {
    if (x < bar.rear() || x > bar.front || z < bar.bottom || z > bar.top) return false;
    const double r = bar.edge_radius;
    const double dx = std::max({bar.rear() + r - x, x - (bar.front - r), 0.0});
    const double dz = std::max(bar.bottom + r - z, 0.0);
    return dx == 0 || dz == 0 || std::hypot(dx, dz) <= r;
}

TEST(Bar, FindsTheClosestPointOfSharpAndRoundedEdges) {
    for (const double radius : {0.0, 0.7, 2.5}) {
        const Bar bar{.front = 0, .thickness = 5, .bottom = 2, .top = 12, .edge_radius = radius};
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
    const Bar bar{.front = 0, .thickness = 5, .bottom = 2, .top = 12, .edge_radius = 0.7};
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

/// Distance from a body of revolution about z between two radii, by brute force: the least over points of its meridian
/// in the half plane of the point, negative in the solid.
double sampled_round(const Cone& cone, const Vec3& x) {
    const double rho = std::hypot(x[0], x[1]), s = x[2] - cone.base[2];
    const double far = cone.side == Side::inside ? 50 : 0;  // where the flat ends end
    double least = 1e9;
    constexpr int n = 20000;
    for (int k = 0; k <= n; ++k) {
        const double u = static_cast<double>(k) / n;
        const auto look = [&](double r, double z) { least = std::min(least, std::hypot(rho - r, s - z)); };
        look(cone.base_radius + u * (cone.end_radius - cone.base_radius), u * cone.length);
        look(cone.base_radius + u * (far - cone.base_radius), 0);
        look(cone.end_radius + u * (far - cone.end_radius), cone.length);
    }
    const double radius = cone.base_radius + s / cone.length * (cone.end_radius - cone.base_radius);
    const bool between = s > 0 && s < cone.length;
    return between && (cone.side == Side::inside ? rho > radius : rho < radius) ? -least : least;
}

/// A turned copy: the axis from z to (0.6, 0, 0.8) about y.
Vec3 tilted(const Vec3& a) {
    return {0.8 * a[0] + 0.6 * a[2], a[1], -0.6 * a[0] + 0.8 * a[2]};
}

TEST(RoundBody, FindsTheClosestPointOfConesAndCylinders) {
    const stats::Stream random(3, 2);
    std::uint64_t draw = 0;
    for (const auto side : {Side::inside, Side::outside})
        for (const auto& [base, end] : {std::pair{3.0, 1.0}, {0.0, 2.0}, {2.0, 2.0}})
            for (int k = 0; k < 40; ++k) {
                const Cone cone{{0, 0, -1}, {0, 0, 1}, base, end, 4, side};
                const auto place = [&] { return -6 + 12 * random.uniform(draw++); };
                const Vec3 x{place(), place(), place() + 1};
                const auto closest = cone.closest(x);
                ASSERT_NEAR(closest.distance, sampled_round(cone, x), 3e-3) << x[0] << " " << x[1] << " " << x[2];
                ASSERT_NEAR(norm(closest.normal), 1, 1e-12);
                const Cone turned{tilted(cone.base), tilted(cone.axis), base, end, 4, side};
                ASSERT_NEAR(turned.closest(tilted(x)).distance, closest.distance, 1e-12);
                ASSERT_NEAR(norm(turned.closest(tilted(x)).normal - tilted(closest.normal)), 0, 1e-10);
                if (base != end) continue;
                const Cylinder same{{0, 0, 1}, {0, 0, 1}, base, side, 4};
                ASSERT_NEAR(same.closest(x).distance, closest.distance, 1e-13);
                ASSERT_NEAR(norm(same.closest(x).normal - closest.normal), 0, 1e-12);
                const Cylinder endless{{0, 0, 77}, {0, 0, 1}, base, side};
                const double from_axis = std::hypot(x[0], x[1]);
                ASSERT_NEAR(endless.closest(x).distance, side == Side::inside ? base - from_axis : from_axis - base,
                            1e-13);
            }
}

TEST(Tube, FindsTheClosestPointOfItsWall) {
    const stats::Stream random(3, 5);
    std::uint64_t draw = 0;
    const Tube tube{{0, 0, -1}, {0, 0, 1}, 2, 2.6, 3};
    const Tube turned{tilted(tube.base), tilted(tube.axis), 2, 2.6, 3};
    for (int k = 0; k < 300; ++k) {
        const auto place = [&] { return -4 + 8 * random.uniform(draw++); };
        const Vec3 x{place(), place(), place()};
        const double rho = std::hypot(x[0], x[1]), s = x[2] + 1;
        double least = 1e9;
        constexpr int n = 4000;
        for (int i = 0; i <= n; ++i) {
            const double u = static_cast<double>(i) / n;
            for (const double r : {2.0, 2.6}) least = std::min(least, std::hypot(rho - r, s - 3 * u));
            for (const double z : {0.0, 3.0}) least = std::min(least, std::hypot(rho - 2 - 0.6 * u, s - z));
        }
        const bool within = rho > 2 && rho < 2.6 && s > 0 && s < 3;
        const auto closest = tube.closest(x);
        ASSERT_NEAR(closest.distance, within ? -least : least, 1e-3) << x[0] << " " << x[1] << " " << x[2];
        ASSERT_NEAR(norm(closest.normal), 1, 1e-12);
        ASSERT_NEAR(tube.closest(x + 1e-6 * closest.normal).distance - closest.distance, 1e-6, 1e-11);
        ASSERT_NEAR(turned.closest(tilted(x)).distance, closest.distance, 1e-12);
        ASSERT_NEAR(norm(turned.closest(tilted(x)).normal - tilted(closest.normal)), 0, 1e-10);
    }
    EXPECT_EQ(tube.closest({1.5, 0, 0}).normal, (Vec3{-1, 0, 0})) << "from the wall to the axis";
    EXPECT_EQ(tube.closest({0, 3, 0}).normal, (Vec3{0, 1, 0}));
    EXPECT_NEAR(tube.extent(2).high, 2, 1e-15);
    EXPECT_NEAR(tube.extent(0).low, -2.6, 1e-15);
    EXPECT_TRUE(tube.unchanged_by_turn({0, 0, 7}, {0, 0, -2}));
    EXPECT_FALSE(tube.unchanged_by_shift({0, 0, 1}));
    EXPECT_EQ(tube.flaw(), "");
    EXPECT_NE((Tube{{}, {0, 0, 1}, 2, 2, 3}).flaw(), "");
}

TEST(Motions, ComposeInClosedForm) {
    const std::vector<geometry::Motion> motions = {
        Translation{.velocity = {0.3, -0.2, 0.1}, .start = 0.5, .end = 2.5},
        Rotation{.point = {1, 0, 0}, .axis = {0, 0, 1}, .speed = 2},
        Vibration{.amplitude = {0, 0.05, 0}, .frequency = 0.7, .phase = 0.4},
        Rotation{.point = {0, 0.5, 0}, .axis = {0.6, 0, 0.8}, .speed = -1.3, .start = 1},
    };
    const Vec3 body{0.7, -0.4, 1.1};
    EXPECT_EQ(pose_at(motions, 0).from_body(body), body);
    for (const double t : {0.2, 0.9, 1.7, 3.1}) {
        const auto pose = pose_at(motions, t);
        EXPECT_NEAR(norm(pose.to_body(pose.from_body(body)) - body), 0, 1e-14);
        const double h = 1e-5;
        const Vec3 rate =
            (1 / (2 * h)) * (pose_at(motions, t + h).from_body(body) - pose_at(motions, t - h).from_body(body));
        EXPECT_NEAR(norm(twist_at(motions, t).at(pose.from_body(body)) - rate), 0, 1e-8) << t;
    }
    // A million turns leave it where it is: nothing adds up.
    const std::vector<geometry::Motion> turns = {Rotation{.axis = {0, 0, 1}, .speed = 2 * std::numbers::pi}};
    EXPECT_NEAR(norm(pose_at(turns, 1e6).from_body({1, 0, 0}) - Vec3{1, 0, 0}), 0, 1e-9);
}

}  // namespace grainsweep::tests::geometry_test
