#include "solver/geometry/contact_memory.hpp"
#include "solver/geometry/mesh.hpp"
#include "tests/support/surfaces.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grainsweep::tests::geometry_contact_memory_test {

using namespace geometry;

Vec3 tilted(double angle) {
    return {std::sin(angle), 0, std::cos(angle)};
}

std::vector<std::uint32_t> matched(const std::vector<Vec3>& before, const std::vector<Vec3>& now) {
    std::vector<std::uint32_t> from(now.size());
    match_contacts(before, now, from);
    return from;
}

/// Numbers a contact gets when it is new and keeps while it goes on, along the way of a sphere.
std::vector<std::vector<int>> numbers_along(const Mesh& mesh, const Vec3& from, const Vec3& to, double reach,
                                            int steps) {
    std::vector<std::vector<int>> way;
    std::vector<Vec3> before;
    std::vector<int> held;
    int next = 0;
    for (int k = 0; k <= steps; ++k) {
        std::vector<MeshContact> found;
        mesh.contacts(from + (static_cast<double>(k) / steps) * (to - from), reach, found);
        std::vector<Vec3> now;
        for (const auto& c : found) now.push_back(c.normal);
        std::vector<int> numbers;
        for (const auto origin : matched(before, now)) numbers.push_back(origin == no_contact ? next++ : held[origin]);
        way.push_back(numbers);
        held = numbers;
        before = now;
    }
    return way;
}

TEST(ContactMemory, GoesToTheNearestNormalAndToOneOnly) {
    using Matches = std::vector<std::uint32_t>;
    EXPECT_EQ(matched({}, {tilted(0)}), (Matches{no_contact}));
    EXPECT_EQ(matched({tilted(0)}, {}), Matches{});
    EXPECT_EQ(matched({tilted(0)}, {tilted(0.1)}), (Matches{0}));
    EXPECT_EQ(matched({tilted(0)}, {tilted(0.2), tilted(0.1)}), (Matches{no_contact, 0})) << "one heir";
    EXPECT_EQ(matched({tilted(0), tilted(0.3)}, {tilted(0.29), tilted(0.28)}), (Matches{1, 0}));
    EXPECT_EQ(matched({tilted(0)}, {tilted(1.5)}), (Matches{no_contact})) << "from a floor to a wall";
    EXPECT_EQ(matched({tilted(0)}, {-tilted(0)}), (Matches{no_contact})) << "through a sheet";
}

TEST(ContactMemory, TurnsWithTheNormal) {
    for (const double angle : {0.0, 1e-9, 0.1, 0.5, 2.0}) {
        const Vec3 n = tilted(0.3), m = tilted(0.3 + angle);
        EXPECT_LT(norm(turned(n, n, m) - m), 1e-15);
        const Vec3 across = {0, 1, 0};
        EXPECT_LT(norm(turned(across, n, m) - across), 1e-15);
        const Vec3 along = 2.0 * tilted(0.3 + 1.5707963267948966);
        EXPECT_NEAR(norm(turned(along, n, m)), 2, 1e-15);
        EXPECT_NEAR(dot(turned(along, n, m), m), 0, 1e-15);
    }
}

TEST(ContactMemory, ADiagonalIsNotNoticedAndAConcaveEdgeBeginsAnother) {
    const Mesh plate(tests::surface_of(tests::plate(1, 4)));
    for (const auto& numbers : numbers_along(plate, {-0.9, -0.83, 0.09}, {0.9, 0.85, 0.09}, 0.1, 333))
        EXPECT_EQ(numbers, std::vector<int>{0});
    // Over the edge of a box: the face, the edge, the other face.
    const Mesh box(tests::surface_of(tests::box(1, 2)));
    std::vector<Vec3> normals;
    const auto over_the_edge = numbers_along(box, {0.9, 0.2, 0.09}, {1.0, 0.2, 0.09}, 0.1, 100);
    for (const auto& numbers : over_the_edge) EXPECT_EQ(numbers, std::vector<int>{0});
    // Into a valley and out of it: the floor's contact ends where the other one goes on.
    const Mesh valley(tests::surface_of(tests::plate(1, 2, [](double x, double) { return 0.2 * std::abs(x); })));
    const auto way = numbers_along(valley, {-0.3, 0.1, 0.16}, {0.3, 0.1, 0.16}, 0.1 * std::sqrt(1.04) + 0.06, 200);
    EXPECT_EQ(way.front(), std::vector<int>{0});
    EXPECT_EQ(way[100].size(), 2U);
    EXPECT_EQ(way.back(), std::vector<int>{1});
}

}  // namespace grainsweep::tests::geometry_contact_memory_test
