// Volume, centre and inertia of unions of spheres, shapes of clumps, covers of meshes.
#include "solver/geometry/ball_union.hpp"
#include "solver/geometry/quaternion.hpp"
#include "solver/machine/grain_shapes.hpp"
#include "tests/support/places.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

namespace grainsweep::tests::clump_shapes_test {

using namespace geometry;
using nlohmann::json;
using std::numbers::pi;

std::vector<Ball> balls_in(const json& list) {
    std::vector<Ball> balls;
    for (const auto& s : list)
        balls.push_back({{s[0].get<double>(), s[1].get<double>(), s[2].get<double>()}, s[3].get<double>()});
    return balls;
}

/// Tensor of a solid from its principal moments and axes.
std::array<double, 6> tensor_of(const Solid& solid) {
    std::array<double, 6> t{};
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& e = solid.axes[k];
        const std::array<double, 6> square = {e[0] * e[0], e[0] * e[1], e[0] * e[2],
                                              e[1] * e[1], e[1] * e[2], e[2] * e[2]};
        for (std::size_t c = 0; c < 6; ++c) t[c] += solid.inertia[k] * square[c];
    }
    return t;
}

TEST(BallUnion, HasTheMassPropertiesOfTheReference) {
    std::ifstream in(tests::reference("clumps/shapes.json"));
    const json all = json::parse(in);
    for (const auto& [name, shape] : all.items()) {
        const Solid solid = solid_of(balls_in(shape["spheres"]));
        EXPECT_NEAR(solid.volume / shape["volume"].get<double>(), 1, 1e-12) << name;
        EXPECT_LT(norm(solid.centre), 1e-14) << name;
        const auto tensor = tensor_of(solid);
        const double size = shape["principal_per_density"][2].get<double>();
        for (std::size_t c = 0; c < 6; ++c)
            EXPECT_NEAR(tensor[c] / size, shape["inertia_per_density"][c].get<double>() / size, 1e-12)
                << name << " " << c;
    }
}

// Two spheres of radius 1, `s` apart: polynomials.
TEST(BallUnion, OfADumbbellIsThePolynomial) {
    for (const double s : {0.1, 0.5, 1.0, 1.5, 1.999, 2.0}) {
        const double h = s / 2;
        const std::vector<Ball> balls = {{{-h, 0, 0}, 1}, {{h, 0, 0}, 1}};
        const Solid solid = solid_of(balls);
        // pi int_0^(h+1) (1 - (x - h)^2) dx, twice
        const auto cap = [h](double x) { return x - std::pow(x - h, 3) / 3; };
        const double volume = 2 * pi * (cap(h + 1) - cap(0));
        EXPECT_NEAR(solid.volume / volume, 1, 1e-13) << s;
        if (s == 2) {
            const double m = solid.volume;
            EXPECT_NEAR(solid.inertia[0] / (0.4 * m), 1, 1e-13);
            EXPECT_NEAR(solid.inertia[1] / (1.4 * m), 1, 1e-13);
            EXPECT_NEAR(solid.inertia[2] / (1.4 * m), 1, 1e-13);
        }
    }
}

TEST(BallUnion, IsTheSameInATurnedFrame) {
    const std::vector<Ball> balls = {{{0, 0, 0}, 1.5}, {{2, 0.2, 0}, 1.2}, {{0.5, 1.6, 0.6}, 0.9}};
    const Solid solid = solid_of(balls);
    for (std::uint64_t n = 1; n < 6; ++n) {
        const double u = static_cast<double>(n) / 6;
        const Quaternion q = orientation_at(u, 0.3 + u / 2, 0.9 - u);
        std::vector<Ball> moved;
        for (const Ball& ball : balls) moved.push_back({turned(q, ball.centre) + Vec3{3, -2, 1}, ball.radius});
        const Solid other = solid_of(moved);
        EXPECT_NEAR(other.volume / solid.volume, 1, 1e-12);
        EXPECT_LT(norm(other.centre - turned(q, solid.centre) - Vec3{3, -2, 1}), 1e-12);
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(other.inertia[k] / solid.inertia[k], 1, 1e-12);
    }
}

TEST(BallUnion, LeavesOutBallsWithinOthers) {
    const std::vector<Ball> balls = {{{0, 0, 0}, 1}, {{0.2, 0.1, 0}, 0.5}, {{0, 0, 0}, 1}};
    EXPECT_NEAR(solid_of(balls).volume, 4 * pi / 3, 1e-12);
}

TEST(BallUnion, OfManyBallsAgreesWithPoints) {
    std::vector<Ball> balls;
    for (int k = 0; k < 30; ++k) {
        const double t = 0.7 * k;
        balls.push_back({{std::cos(t), std::sin(1.3 * t), std::cos(0.4 * t + 1)}, 0.4 + 0.2 * std::sin(t)});
    }
    const Solid solid = solid_of(balls);
    double inside = 0, all = 0;
    constexpr int n = 120;
    for (int x = 0; x < n; ++x)
        for (int y = 0; y < n; ++y)
            for (int z = 0; z < n; ++z) {
                const Vec3 p = {-2 + 4 * (x + 0.5) / n, -2 + 4 * (y + 0.5) / n, -2 + 4 * (z + 0.5) / n};
                ++all;
                for (const Ball& ball : balls)
                    if (norm(p - ball.centre) < ball.radius) {
                        ++inside;
                        break;
                    }
            }
    EXPECT_NEAR(solid.volume / (64 * inside / all), 1, 2e-3);
}

TEST(Quaternions, ComeFromAxesAndBack) {
    for (const double u : {0.01, 0.3, 0.5, 0.77, 0.99})
        for (const double v : {0.0, 0.2, 0.61}) {
            const Quaternion q = orientation_at(u, v, 0.37 + v / 3);
            EXPECT_NEAR(magnitude(q), 1, 1e-15);
            const auto rows = rows_of(q);
            std::array<Vec3, 3> axes{};
            for (std::size_t k = 0; k < 3; ++k) axes[k] = {rows[0][k], rows[1][k], rows[2][k]};
            const Quaternion back = orientation_of(axes);
            const Quaternion same = product(conjugate(q), back);
            EXPECT_NEAR(std::abs(same[0]), 1, 1e-14);
        }
}

TEST(ClumpShapes, OfAnAspectRatioHaveTheSpheresOfTheNote) {
    for (const auto& [ratio, count] : {std::pair{1.1, 2U}, {1.5, 2U}, {1.6, 3U}, {2.0, 3U}, {2.1, 4U}, {4.0, 7U}}) {
        const auto shape = machine::row_shape(ratio);
        ASSERT_EQ(shape.clump.balls.size(), count) << ratio;
        // In units of the diameter of the sphere of equal volume.
        std::vector<Ball> balls = shape.clump.balls;
        EXPECT_NEAR(solid_of(balls).volume, pi / 6, 1e-12);
        const double width = 2 * balls.front().radius, length = 2 * shape.clump.reach();
        EXPECT_NEAR(length / width, ratio, 1e-12);
        EXPECT_EQ(shape.clump.long_axis(), 0U);
        EXPECT_EQ(shape.clump.lightness, 1) << ratio;
    }
}

std::string why_not(std::vector<Ball> balls) {
    try {
        (void)machine::ball_shape(std::move(balls));
    } catch (const std::invalid_argument& why) {
        return why.what();
    }
    return "";
}

TEST(ClumpShapes, WrongOnesGetASentence) {
    EXPECT_NE(why_not({}).find("needs spheres"), std::string::npos);
    EXPECT_NE(why_not({{{0, 0, 0}, 1}}).find("one sphere is a sphere"), std::string::npos);
    EXPECT_NE(why_not({{{0, 0, 0}, 1}, {{0.2, 0, 0}, 0.5}}).find("sphere 2 lies within sphere 1"), std::string::npos);
    EXPECT_NE(why_not({{{0, 0, 0}, 1}, {{0, 0, 0}, 1}}).find("sphere 2 lies within sphere 1"), std::string::npos);
    EXPECT_NE(why_not({{{0, 0, 0}, 1}, {{2.1, 0, 0}, 1}}).find("fall into pieces"), std::string::npos);
    EXPECT_NE(why_not({{{0, 0, 0}, 1}, {{1, 0, 0}, 0}}).find("above 0"), std::string::npos);
    EXPECT_NE(why_not({{{0, 0, 0}, 1}, {{1, 0, 0}, -1}}).find("above 0"), std::string::npos);
    EXPECT_NE(why_not({{{0, 0, 0}, 1}, {{1, 0, 0}, 1e-4}}).find("one unit"), std::string::npos);
    EXPECT_NE(why_not({{{0, 0, 0}, 1}, {{std::nan(""), 0, 0}, 1}}).find("finite"), std::string::npos);
    EXPECT_NE(why_not(std::vector<Ball>(10000, Ball{{0, 0, 0}, 1})).find("at most 200"), std::string::npos);
    EXPECT_EQ(why_not({{{0, 0, 0}, 1}, {{2, 0, 0}, 1}}), "");
}

std::string why_no_mass(const machine::OwnMass& own) {
    auto shape = machine::row_shape(1.5);
    try {
        machine::take_mass(shape, own, 5e-3, 2500);
    } catch (const std::invalid_argument& why) {
        return why.what();
    }
    return "";
}

TEST(ClumpShapes, HaveAMassOfTheirOwn) {
    auto shape = machine::row_shape(1.5);
    const auto plain = shape.clump;
    machine::take_mass(shape, {.mass = 1e-4}, 5e-3, 2500);
    EXPECT_NEAR(shape.clump.mass * 2500 * 125e-9, 1e-4, 1e-16);
    for (std::size_t k = 0; k < 3; ++k)
        EXPECT_NEAR(shape.clump.inertia[k] / plain.inertia[k], shape.clump.mass / plain.mass, 1e-12);
    EXPECT_NE(why_no_mass({.mass = 0.16}).find("check the units"), std::string::npos);
    EXPECT_NE(why_no_mass({.mass = 1e-10}).find("check the units"), std::string::npos);
    EXPECT_NE(why_no_mass({.inertia = Inertia{1e-10, 0, 0, 1e-10, 0, 3e-10}}).find("no body has"), std::string::npos);
    EXPECT_NE(why_no_mass({.inertia = Inertia{1e-10, 0, 0, -1e-10, 0, 1e-10}}).find("no body has"), std::string::npos);
    EXPECT_NE(why_no_mass({.inertia = Inertia{1e-7, 0, 0, 1e-7, 0, 1e-7}}).find("radius of gyration"),
              std::string::npos);
    EXPECT_NE(why_no_mass({.inertia = Inertia{1e-14, 0, 0, 1e-14, 0, 1e-14}}).find("units"), std::string::npos);
    EXPECT_NE(why_no_mass({.centre = Vec3{9, 0, 0}}).find("outside of it"), std::string::npos);
    EXPECT_EQ(why_no_mass({.inertia = Inertia{3e-10, 0, 0, 5e-10, 0, 5e-10}}), "");
}

/// A cuboid as STL.
std::string stl_of_box(const Vec3& size, bool open = false) {
    std::string text = "solid box\n";
    const auto facet = [&](const Vec3& a, const Vec3& b, const Vec3& c) {
        text += "facet normal 0 0 0\nouter loop\n";
        for (const Vec3& x : {a, b, c})
            text += "vertex " + std::to_string(x[0]) + " " + std::to_string(x[1]) + " " + std::to_string(x[2]) + "\n";
        text += "endloop\nendfacet\n";
    };
    for (std::size_t k = 0; k < 3; ++k)
        for (const double side : {0.0, 1.0}) {
            if (open && k == 2 && side > 0) continue;
            std::array<Vec3, 4> c{};
            for (std::size_t i = 0; i < 4; ++i) {
                c[i][k] = side * size[k];
                c[i][(k + 1) % 3] = (i == 1 || i == 2 ? 1 : 0) * size[(k + 1) % 3];
                c[i][(k + 2) % 3] = (i >= 2 ? 1 : 0) * size[(k + 2) % 3];
            }
            facet(c[0], c[1], c[2]);
            facet(c[0], c[2], c[3]);
        }
    return text + "endsolid box\n";
}

TEST(ClumpShapes, CoverAMesh) {
    const auto shape = machine::mesh_shape(stl_of_box({2, 1, 1}), {});
    EXPECT_GE(shape.clump.balls.size(), 8U);
    EXPECT_LE(shape.clump.balls.size(), 16U);
    EXPECT_GT(*shape.overlap, 0.75);
    EXPECT_NEAR(solid_of(shape.clump.balls).volume, pi / 6, 1e-9);
    EXPECT_NEAR(shape.solid.volume, 2, 1e-6);
    // Mass and inertia are those of the box.
    const double d5 = std::pow(shape.clump.diameter, 5);
    EXPECT_NEAR(shape.clump.inertia[0] * d5, 2.0 * 2 / 12, 1e-6);
    EXPECT_NEAR(shape.clump.inertia[1] * d5, 2.0 * 5 / 12, 1e-6);
    EXPECT_NEAR(norm(shape.solid.centre - Vec3{1, 0.5, 0.5}), 0, 1e-6);
    const auto fine = machine::mesh_shape(stl_of_box({2, 1, 1}), {.most = 40});
    EXPECT_GT(*fine.overlap, *shape.overlap);
    EXPECT_THROW((void)machine::mesh_shape(stl_of_box({2, 1, 1}, true), {}), std::invalid_argument);
    EXPECT_THROW((void)machine::mesh_shape("solid nothing\nendsolid\n", {}), std::invalid_argument);
}

}  // namespace grainsweep::tests::clump_shapes_test
