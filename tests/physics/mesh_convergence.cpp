// Walls made of triangles against the walls they stand for: a plate cut in any way is the plane, and a tessellated
// cylinder or cone tends to the curved one.
#include "solver/dem/engine.hpp"
#include "tests/support/moving_walls.hpp"
#include "tests/support/spheres.hpp"
#include "tests/support/surfaces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace grainsweep::tests::mesh_convergence_test {

using namespace geometry;
using dem::Vec3;
using std::numbers::pi;

constexpr double radius = tests::sphere_at_walls;

/// Frustum about x between -h and h, inside or outside, of n flat facets with their corners on the circles.
Soup frustum(int n, double first, double last, double h) {
    Soup soup;
    const auto corner = [&](double x, double r, int k) {
        const double angle = 2 * pi * (k % n + 0.3) / n;
        return Vec3{x, r * std::cos(angle), r * std::sin(angle)};
    };
    for (int k = 0; k < n; ++k)
        soup = tests::joined(soup, tests::quadrilateral(corner(-h, first, k), corner(-h, first, k + 1),
                                                        corner(h, last, k + 1), corner(h, last, k)));
    return soup;
}

/// One contact everywhere: the angle between two facets is 2 pi/n at most.
dem::Mesh smooth(const Soup& soup, int n) {
    return dem::Mesh(tests::surface_of(soup), 1.5 * 2 * pi / n);
}

/// Distance of the sphere from where it is with another wall, over its diameter.
double apart(dem::Setup setup, const dem::Wall& one, const dem::Wall& other, std::int64_t steps) {
    std::vector<Vec3> ends;
    for (const auto* wall : {&one, &other}) {
        setup.walls = {*wall};
        const auto engine = dem::make_engine(setup, {});
        engine->run(steps);
        EXPECT_EQ(engine->fault(), "");
        ends.push_back(state_of(*engine).position[0]);
    }
    return norm(ends[0] - ends[1]) / (2 * radius);
}

/// Slope of the logarithms by least squares: error ~ n^-order.
double observed_order(const std::vector<int>& n, const std::vector<double>& error) {
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (std::size_t k = 0; k < n.size(); ++k) {
        const double x = std::log(n[k]), y = std::log(error[k]);
        sx += x, sy += y, sxx += x * x, sxy += x * y;
    }
    const auto count = static_cast<double>(n.size());
    return -(count * sxy - sx * sy) / (count * sxx - sx * sx);
}

// 2, 8 and 200 triangles, and corners at other places on the one half than on the other: a sphere that bounces, slides
// and rolls over them for 80 ms is where it is on the plane.
TEST(MeshConvergence, APlateCutInAnyWayIsThePlane) {
    const auto end = [&](const dem::Wall& wall, const Vec3& v, double rolling, double surface_energy) {
        auto setup = one_sphere({-0.0061, -0.0053, 1.2e-3}, v, {wall});
        setup.gravity = {0.7, 0.3, -9.6};
        setup.material.rolling_friction = rolling;
        setup.material.surface_energy = surface_energy;
        setup.material.cohesion_law = dem::CohesionLaw::jkr;
        setup.spheres[0].angular_velocity = {20, -50, 30};
        setup.time_step = 2e-6;
        const auto engine = dem::make_engine(setup, {});
        engine->run(40000);
        EXPECT_EQ(engine->fault(), "");
        return state_of(*engine);
    };
    const Soup halves = tests::joined(
        tests::joined(tests::quadrilateral({-0.02, -0.02, 0}, {0, -0.02, 0}, {0, 0.003, 0}, {-0.02, 0.003, 0}),
                      tests::quadrilateral({-0.02, 0.003, 0}, {0, 0.003, 0}, {0, 0.02, 0}, {-0.02, 0.02, 0})),
        tests::quadrilateral({0, -0.02, 0}, {0.02, -0.02, 0}, {0.02, 0.02, 0}, {0, 0.02, 0}));
    for (const Vec3& v : {Vec3{0.1, 0.08, -0.2}, Vec3{0.07, 0.13, 0}})
        for (const auto& [rolling, energy] : {std::pair(0.0, 0.0), std::pair(0.05, 0.0), std::pair(0.0, 0.02)}) {
            const auto plane = end(dem::Plane{}, v, rolling, energy);
            for (const Soup& soup : {tests::plate(0.02, 1), tests::plate(0.02, 2), tests::plate(0.02, 10),
                                     tests::plate(0.01, 40), halves}) {
                const auto cut = end(dem::Mesh(tests::surface_of(soup)), v, rolling, energy);
                EXPECT_LT(norm(cut.position[0] - plane.position[0]), 1e-9 * 2 * radius) << soup.size();
                EXPECT_LT(norm(cut.velocity[0] - plane.velocity[0]), 1e-9 * norm(v)) << soup.size();
                EXPECT_LT(radius * norm(cut.angular_velocity[0] - plane.angular_velocity[0]), 1e-9 * norm(v));
            }
            EXPECT_GT(norm(plane.position[0] - Vec3{-0.0061, -0.0053, radius}), 0.004) << "over many triangles";
        }
}

// Sixty spheres in a box of triangles that is open nowhere, as between six planes: floors, edges and corners at once.
// And it goes on from a checkpoint to the same bits.
TEST(MeshConvergence, ABoxOfTrianglesHoldsAGasAsOneOfPlanesDoes) {
    const auto planes = tests::boxed_gas(60, 0.5, 2, 3);
    double length = 0;
    for (const auto& wall : planes.walls) length = std::max(length, std::get<dem::Plane>(wall.shape).point[0]);
    auto triangles = planes;
    Soup box;
    for (const auto& triangle : tests::box(length / 2, length))
        for (auto& moved = box.emplace_back(triangle); Vec3 & corner : moved)
            corner += Vec3{length / 2, length / 2, length};
    triangles.walls = {dem::Mesh(tests::surface_of(box))};
    const auto one = dem::make_engine(planes, {}), other = dem::make_engine(triangles, {});
    one->run(400), other->run(400);
    const auto a = state_of(*one), b = state_of(*other);
    ASSERT_EQ(a.id, b.id);
    for (std::size_t i = 0; i < a.id.size(); ++i)
        ASSERT_LT(norm(a.position[i] - b.position[i]), 1e-9 * 2 * radius) << i;

    std::vector<std::byte> half, whole, again;
    other->save(half);
    auto empty = triangles;
    empty.walls.clear();
    const auto restored = dem::make_engine(empty, {});
    restored->restore(half);
    other->run(600), restored->run(600);
    EXPECT_EQ(other->fault(), "");
    other->save(whole), restored->save(again);
    EXPECT_EQ(whole, again);
}

// The height of an arc over its chord falls as n^-2, and so does where a sphere is after 20 to 40 ms, as soon as the
// jumps of the normal between facets are small (README of the reference, defect 10): observed orders 1.9 (drum), 2.0
// (down a cone), 1.8 (around it).
TEST(MeshConvergence, ATessellatedCylinderTendsToTheCylinder) {
    constexpr double drum = 0.02, overlap = 8e-6;
    auto setup =
        one_sphere({0, -(drum - radius + overlap) * std::sin(1.0), -(drum - radius + overlap) * std::cos(1.0)}, {}, {});
    setup.gravity = {0, 0, -9.81};
    setup.material.friction = 0.5;
    setup.time_step = 2e-6;
    const std::vector<int> n = {128, 256, 512, 1024, 2048};
    std::vector<double> error;
    for (const int k : n)
        error.push_back(apart(setup, dem::Cylinder{.axis = {1, 0, 0}, .radius = drum},
                              smooth(frustum(k, drum, drum, 0.01), k), 20000));
    EXPECT_NEAR(observed_order(n, error), 2, 0.5);
    EXPECT_LT(error.back(), 5e-3);
    RecordProperty("order", std::to_string(observed_order(n, error)));
}

TEST(MeshConvergence, ATessellatedConeTendsToTheCone) {
    constexpr double h = 0.02, overlap = 8e-6;
    const double slope = std::tan(pi / 6), first = 0.02 - h * slope, last = 0.02 + h * slope;
    const dem::Cone cone{
        .base = {-h, 0, 0}, .axis = {1, 0, 0}, .base_radius = first, .end_radius = last, .length = 2 * h};
    auto setup = one_sphere({0, 0.02 - (radius - overlap) / std::cos(pi / 6), 0}, {}, {});
    setup.gravity = {-9.81, 0, 0};
    setup.time_step = 2e-6;
    for (const bool around : {false, true}) {  // sliding down; rolling around
        setup.material.friction = around ? 0.5 : 0.1;
        setup.spheres[0].velocity = {0, 0, around ? 0.3 : 0.0};
        const std::vector<int> n = {128, 256, 512, 1024, 2048};
        std::vector<double> error;
        for (const int k : n)
            error.push_back(apart(setup, cone, smooth(frustum(k, first, last, h), k), around ? 20000 : 10000));
        EXPECT_NEAR(observed_order(n, error), 2.0, around ? 0.3 : 0.1);
        EXPECT_LT(error.back(), 2e-3);
        RecordProperty(around ? "order_around" : "order_down", std::to_string(observed_order(n, error)));
    }
}

// Facets alone do not: at an inner edge both are touched, with nearly twice the stiffness, however fine they are.
TEST(MeshConvergence, WithoutTheAngleAnInnerEdgeIsTwoContacts) {
    constexpr double drum = 0.02, overlap = 8e-6;
    for (const int n : {64, 512}) {
        const double corner = 2 * pi * 0.3 / n, away = drum - radius + overlap;
        const auto setup = one_sphere({0, away * std::cos(corner), away * std::sin(corner)}, {}, {});
        const auto contacts = [&](const dem::Mesh& mesh) {
            auto with = setup;
            with.walls = {mesh};
            std::vector<dem::ContactForce> found;
            dem::make_engine(with, {})->contacts(found);
            return found.size();
        };
        EXPECT_EQ(contacts(dem::Mesh(tests::surface_of(frustum(n, drum, drum, 0.01)))), 2U) << n;
        EXPECT_EQ(contacts(smooth(frustum(n, drum, drum, 0.01), n)), 1U) << n;
    }
}

}  // namespace grainsweep::tests::mesh_convergence_test
