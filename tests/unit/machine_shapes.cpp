// Shapes of a machine that are made of triangles: areas, faces that are left out, places.
#include "solver/machine/shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>

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

}  // namespace grainsweep::tests::machine_shapes_test
