// Shapes of a machine that are made of triangles: areas, faces that are left out, places.
#include "solver/geometry/weld.hpp"
#include "solver/machine/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <set>
#include <stdexcept>
#include <string>

namespace grainsweep::tests::machine_shapes_test {

using namespace geometry;
using machine::Triangles;

double area_of(const Triangles& triangles) {
    double area = 0;
    for (const auto& [a, b, c] : triangles) area += norm(cross(b - a, c - a)) / 2;
    return area;
}

/// Sum of (a x b) over all edges over 2: the vector area.
Vec3 vector_area(const Triangles& triangles) {
    Vec3 area{};
    for (const auto& [a, b, c] : triangles) area += 0.5 * cross(b - a, c - a);
    return area;
}

TEST(MachineShapes, ADiscHasTheAreaOfTheCircle) {
    for (const Vec3& normal : {Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{0.6, 0, -0.8}}) {
        const Triangles full = machine::triangles_of(machine::Disc{{1, 2, 3}, normal, 0.5, 0});
        EXPECT_EQ(full.size(), 64U);
        EXPECT_NEAR(area_of(full), std::numbers::pi * 0.25, 1e-12);
        const Vec3 up = vector_area(full);
        EXPECT_NEAR(std::abs(dot(up, normal)), std::numbers::pi * 0.25, 1e-12) << "flat and across its normal";
        for (const auto& triangle : full)
            for (const Vec3& corner : triangle) EXPECT_NEAR(dot(corner - Vec3{1, 2, 3}, normal), 0, 1e-15);
        const Triangles ring = machine::triangles_of(machine::Disc{{1, 2, 3}, normal, 0.5, 0.2});
        EXPECT_EQ(ring.size(), 128U);
        EXPECT_NEAR(area_of(ring), std::numbers::pi * (0.25 - 0.04), 1e-12);
    }
    EXPECT_THROW((void)machine::triangles_of(machine::Disc{{}, {0, 0, 1}, 0.5, 0.5}), std::invalid_argument);
}

TEST(MachineShapes, ABoxLeavesOutItsOpenFaces) {
    const Vec3 low{0, 0, 0}, high{1, 2, 3};
    const Triangles closed = machine::triangles_of(machine::Box{low, high, {}});
    EXPECT_EQ(closed.size(), 12U);
    EXPECT_DOUBLE_EQ(area_of(closed), 2 * (2 + 3 + 6));
    const double faces[] = {6, 6, 3, 3, 2, 2};
    for (std::size_t face = 0; face < 6; ++face) {
        std::array<bool, 6> open{};
        open[face] = true;
        const Triangles rest = machine::triangles_of(machine::Box{low, high, open});
        EXPECT_EQ(rest.size(), 10U);
        EXPECT_DOUBLE_EQ(area_of(rest), 22 - faces[face]);
        // No triangle of the rest lies in the plane of the open face.
        const double level = face % 2 == 0 ? low[face / 2] : high[face / 2];
        for (const auto& [a, b, c] : rest)
            EXPECT_FALSE(a[face / 2] == level && b[face / 2] == level && c[face / 2] == level) << face;
    }
    EXPECT_TRUE(machine::triangles_of(machine::Box{low, high, {true, true, true, true, true, true}}).empty());
    EXPECT_THROW((void)machine::triangles_of(machine::Box{high, low, {}}), std::invalid_argument);
    EXPECT_THROW((void)machine::mesh_of({}, 0, {}), std::invalid_argument);
}

TEST(MachineShapes, AShapeIsTurnedThenShifted) {
    const Triangles flat = machine::triangles_of(machine::Rectangle{{1, 0, 0}, {1, 0, 0}, {0, 1, 0}});
    EXPECT_EQ(flat.size(), 2U);
    EXPECT_DOUBLE_EQ(area_of(flat), 1);
    // A quarter turn about z through (1, 0, 0) takes +x to +y; then 5 up.
    const machine::Placement placement{{0, 0, 1}, {1, 0, 0}, std::numbers::pi / 2, {0, 0, 5}};
    const Mesh mesh = machine::mesh_of(flat, 0, placement);
    const auto extent = [&](std::size_t k) { return std::pair(mesh.extent(k).low, mesh.extent(k).high); };
    EXPECT_NEAR(extent(0).first, 0, 1e-12);
    EXPECT_NEAR(extent(0).second, 1, 1e-12);
    EXPECT_NEAR(extent(1).first, 0, 1e-12);
    EXPECT_NEAR(extent(1).second, 1, 1e-12);
    EXPECT_NEAR(extent(2).first, 5, 1e-12);
    EXPECT_NEAR(extent(2).second, 5, 1e-12);
}

TEST(MachineShapes, AnStlFileIsScaledAndPlacedAlike) {
    const char* stl = R"(solid one
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 10 0 0
vertex 0 20 0
endloop
endfacet
endsolid one
)";
    const Mesh mesh = machine::stl_mesh(stl, 1e-3, 0, {{0, 0, 1}, {}, std::numbers::pi, {0, 0, 1}});
    EXPECT_NEAR(mesh.extent(0).low, -0.01, 1e-12);
    EXPECT_NEAR(mesh.extent(0).high, 0, 1e-12);
    EXPECT_NEAR(mesh.extent(1).low, -0.02, 1e-12);
    EXPECT_NEAR(mesh.extent(2).low, 1, 1e-12);
    EXPECT_THROW((void)machine::stl_mesh("no stl", 1, 0, {}), std::invalid_argument);
    EXPECT_THROW((void)machine::mesh_of({{Vec3{}, Vec3{}, Vec3{}}}, 0, {}), std::invalid_argument) << "without area";
}

using machine::Perforated;

TEST(MachineShapes, APerforatedPlateHasHolesAndNoOtherGap) {
    constexpr double hole = 5e-3, pitch = 8.3e-3, width = 0.033;
    const double corner = hole / 2 / std::cos(std::numbers::pi / 32);
    const double hole_area = 16 * corner * corner * std::sin(2 * std::numbers::pi / 32);
    struct Plate {
        Perforated::Pattern pattern;
        double length;
        int holes;
    };
    for (const auto& [pattern, length, holes] :
         {Plate{Perforated::Pattern::square, 0.1, 36}, Plate{Perforated::Pattern::square, 4 * pitch, 12},
          Plate{Perforated::Pattern::triangular, 0.1, 46}, Plate{Perforated::Pattern::triangular, 0.047, 18}}) {
        const Triangles plate =
            machine::triangles_of(Perforated{{0.1, 0.2, 0.3}, {length, 0, 0}, {0, 0, width}, hole, pitch, pattern});
        EXPECT_NEAR(area_of(plate), length * width - holes * hole_area, 1e-12);
        EXPECT_NEAR(norm(vector_area(plate)), area_of(plate), 1e-12) << "no triangle is turned over";
        // Every side belongs to two triangles, but for those of holes and of the plate's own edges.
        const auto surface = geometry::weld(plate).surface;
        std::map<std::array<std::int32_t, 2>, int> sides;
        for (const auto& triangle : surface.triangles)
            for (std::size_t k = 0; k < 3; ++k) {
                const auto [a, b] = std::minmax(triangle[k], triangle[(k + 1) % 3]);
                ++sides[{a, b}];
            }
        int at_holes = 0;
        for (const auto& [side, count] : sides) {
            ASSERT_LE(count, 2);
            const Vec3 middle = 0.5 * (surface.corners[static_cast<std::size_t>(side[0])] +
                                       surface.corners[static_cast<std::size_t>(side[1])]) -
                                Vec3{0.1, 0.2, 0.3};
            const bool outer = std::min({middle[0], length - middle[0], middle[2], width - middle[2]}) < 1e-9;
            if (count == 1 && !outer) ++at_holes;
        }
        EXPECT_EQ(at_holes, 32 * holes);
    }
}

TEST(MachineShapes, WrongPerforatedPlatesAreRefused) {
    const auto why = [](const Perforated& plate) {
        try {
            (void)machine::triangles_of(plate);
        } catch (const std::invalid_argument& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    using enum Perforated::Pattern;
    EXPECT_EQ(why({{}, {1, 0, 0}, {0.1, 1, 0}, 0.1, 0.2, square}),
              "\"along\" and \"across\" of a plate must be at a right angle");
    EXPECT_EQ(why({{}, {1, 0, 0}, {0, 1, 0}, 0.1, 1.5, square}), "the plate is smaller than a pitch");
    EXPECT_EQ(why({{}, {1, 0, 0}, {0, 1, 0}, 0.2, 0.2, square}),
              "holes must leave a web between them: less than 0.99 pitches wide, and 0.86 in a triangular pattern");
    EXPECT_EQ(why({{}, {1, 0, 0}, {0, 1, 0}, 0.19, 0.2, square}), "");
    EXPECT_NE(why({{}, {1, 0, 0}, {0, 1, 0}, 0.19, 0.2, triangular}), "");
    EXPECT_EQ(why({{}, {1, 0, 0}, {0, 1, 0}, 0.001, 0.01, square}),
              "the plate has more than 5000 holes: make it periodic");
}

}  // namespace grainsweep::tests::machine_shapes_test
