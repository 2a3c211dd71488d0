#include "solver/geometry/mesh.hpp"
#include "stats/random.hpp"
#include "tests/support/surfaces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grainsweep::tests::geometry_mesh_test {

using namespace geometry;

Mesh mesh_of(const Soup& soup, double one_contact_angle = 0) {
    return Mesh(tests::surface_of(soup), one_contact_angle);
}

std::vector<MeshContact> contacts(const Mesh& mesh, const Vec3& x, double reach) {
    std::vector<MeshContact> found;
    mesh.contacts(x, reach, found);
    return found;
}

void expect_as_plain(const Soup& soup, const Mesh& mesh, const Vec3& x, double reach) {
    const auto found = contacts(mesh, x, reach);
    const auto expected = tests::plain_contacts(soup, x, reach, mesh.tolerance());
    ASSERT_EQ(found.size(), expected.size()) << x[0] << " " << x[1] << " " << x[2] << " reach " << reach;
    for (std::size_t k = 0; k < found.size(); ++k) {
        ASSERT_NEAR(found[k].distance, expected[k].distance, 1e-12);
        ASSERT_LT(norm(found[k].point - expected[k].point), 1e-9);
        ASSERT_LT(norm(x - found[k].distance * found[k].normal - found[k].point), 1e-12);
        ASSERT_NEAR(norm(found[k].normal), 1, 1e-14);
    }
}

TEST(Mesh, FindsTheContactsOfThePlainRule) {
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
        const Soup waves = tests::plate(1, 6, [&](double x, double y) {
            return 0.3 * std::sin(3 * x + static_cast<double>(seed)) * std::cos(4 * y);
        });
        const Soup closed = tests::joined(tests::box(0.5, 0.7), tests::drum(11, 0.9, 0.4));
        for (const Soup& soup : {random_soup(seed, 40, 0.8), random_fans(seed), waves, closed}) {
            const Mesh mesh = mesh_of(soup);
            const stats::Stream random(seed, 8);
            std::uint64_t at = 0;
            for (int k = 0; k < 60; ++k) {
                const Vec3 x = draw(random, at, {1.2, 1.2, 1.2});
                expect_as_plain(soup, mesh, x, 0.8 * random.uniform(at++));
                if (HasFatalFailure()) return;
            }
        }
    }
}

TEST(Mesh, PreparedForSpheresItFindsTheSameBits) {
    for (std::uint64_t seed = 1; seed <= 6; ++seed) {
        const Soup waves =
            tests::plate(1, 12, [](double x, double y) { return 0.3 * std::sin(3 * x) * std::cos(4 * y); });
        for (const Soup& soup : {random_soup(seed, 60, 0.8), random_fans(seed), waves, shattered_plate(seed, 40),
                                 tests::joined(tests::box(0.5, 0.7), tests::drum(31, 0.9, 0.4))}) {
            const Mesh mesh = mesh_of(soup, seed % 2 == 0 ? 0.3 : 0);
            for (const double reach : {0.02, 0.2, 1.5}) {
                const Mesh prepared = mesh.prepared(reach);
                const stats::Stream random(seed, 11);
                std::uint64_t at = 0;
                for (int k = 0; k < 80; ++k) {
                    const Vec3 x = draw(random, at, {1.4, 1.4, 1.4});
                    for (const double own : {0.5 * reach, reach, 1.1 * reach}) {
                        std::vector<Closest> plain, found;
                        mesh.touching(x, own, plain);
                        prepared.touching(x, own, found);
                        ASSERT_EQ(plain.size(), found.size());
                        for (std::size_t c = 0; c < plain.size(); ++c) {
                            ASSERT_EQ(plain[c].distance, found[c].distance);
                            ASSERT_EQ(plain[c].normal, found[c].normal);
                        }
                    }
                }
            }
        }
    }
}

TEST(Mesh, AContactIsALeastDistanceAndTheLeastOfAllIsOne) {
    for (std::uint64_t seed = 1; seed <= 10; ++seed) {
        const Soup soup = tests::joined(random_fans(seed), random_soup(seed, 10, 0.5));
        const Mesh mesh = mesh_of(soup);
        const stats::Stream random(seed, 9);
        std::uint64_t at = 0;
        for (int k = 0; k < 40; ++k) {
            const Vec3 x = draw(random, at, {1.5, 1.5, 1.5});
            double least = 1e9;
            for (const auto& t : soup) least = std::min(least, norm(x - tests::plain_nearest(t, x)));
            const auto found = contacts(mesh, x, 3);
            ASSERT_FALSE(found.empty());
            ASSERT_NEAR(found.front().distance, least, 1e-13);
            // Beside its point the surface is farther away.
            for (const auto& c : found)
                for (const auto& t : soup) {
                    const Vec3 beside = c.point + 1e-5 * draw(random, at, {1, 1, 1});
                    const Vec3 on_surface = tests::plain_nearest(t, beside);
                    if (norm(on_surface - c.point) > 1e-5) continue;
                    ASSERT_GE(norm(x - on_surface), c.distance - 1e-13);
                }
        }
    }
}

TEST(Mesh, NoBitDependsOnTheOrderOfTriangles) {
    for (const Soup& soup : {random_fans(3), tests::plate(1, 5, [](double x, double y) { return 0.2 * x * y; }),
                             shattered_plate(2, 30), tests::drum(23, 1, 0.7)}) {
        const Mesh first = mesh_of(soup, 0.01);
        const stats::Stream random(4, 1);
        std::uint64_t at = 0;
        std::vector<Vec3> places;
        for (int k = 0; k < 60; ++k) places.push_back(draw(random, at, {1, 1, 0.6}));
        for (const auto& t : soup) places.push_back(0.5 * (t[0] + t[1]) + Vec3{0, 0, 0.1});  // above edges
        for (const auto& t : soup) places.push_back(t[2] - Vec3{0, 0, 0.2});                 // below corners
        for (std::uint64_t seed = 1; seed <= 4; ++seed) {
            const Mesh other = mesh_of(tests::shuffled(soup, seed), 0.01);
            for (const Vec3& x : places) {
                const auto a = contacts(first, x, 0.7);
                const auto b = contacts(other, x, 0.7);
                ASSERT_EQ(a.size(), b.size());
                for (std::size_t k = 0; k < a.size(); ++k) {
                    ASSERT_EQ(a[k].point, b[k].point);
                    ASSERT_EQ(a[k].normal, b[k].normal);
                    ASSERT_EQ(a[k].distance, b[k].distance);
                    ASSERT_EQ(a[k].feature, b[k].feature);
                }
            }
        }
    }
}

TEST(Mesh, APlateCutIntoTrianglesInAnyWayIsAPlane) {
    // Slivers and needles among them; a T-junction at every crossing of the last one.
    Soup slivers = tests::quadrilateral({-1, -1, 0}, {-0.002, -1, 0}, {-0.002, 1, 0}, {-1, 1, 0});
    slivers = tests::joined(slivers, tests::quadrilateral({-0.002, -1, 0}, {0, -1, 0}, {0, 1, 0}, {-0.002, 1, 0}));
    slivers = tests::joined(slivers, tests::quadrilateral({0, -1, 0}, {1, -1, 0}, {1, 1, 0}, {0, 1, 0}));
    Soup junctions = tests::quadrilateral({-1, -1, 0}, {0, -1, 0}, {0, 1, 0}, {-1, 1, 0});
    for (int k = 0; k < 6; ++k)
        junctions =
            tests::joined(junctions, tests::quadrilateral({0, -1 + k / 3.0, 0}, {1, -1 + k / 3.0, 0},
                                                          {1, -1 + (k + 1) / 3.0, 0}, {0, -1 + (k + 1) / 3.0, 0}));
    for (const Soup& soup : {tests::plate(1, 1), tests::plate(1, 2), tests::plate(1, 10), slivers, junctions,
                             shattered_plate(1, 60), shattered_plate(2, 200)}) {
        const Mesh mesh = mesh_of(soup);
        const stats::Stream random(5, 1);
        std::uint64_t at = 0;
        std::vector<Vec3> feet;
        for (int k = 0; k < 200; ++k) feet.push_back(draw(random, at, {0.999, 0.999, 0}));
        for (int k = -9; k <= 9; ++k) {  // on diagonals, edges and vertices, and beside them by rounding
            const double s = k / 10.0;
            for (const double off : {0.0, 1e-17, -1e-16, 3e-13, 1e-9, -4e-8, 3e-7}) {
                feet.push_back({s, s + off, 0});
                feet.push_back({off, s, 0});
                feet.push_back({s + off, 0.2 - off, 0});
            }
        }
        for (const auto& t : soup) feet.push_back(0.999 * t[0]);
        for (const double height : {0.01, -0.3, 0.9})
            for (const Vec3& foot : feet) {
                const Vec3 x = foot + Vec3{0, 0, height};
                const auto found = contacts(mesh, x, 1.2 * std::abs(height));
                ASSERT_EQ(found.size(), 1U) << foot[0] << " " << foot[1] << " " << height;
                ASSERT_NEAR(found[0].distance, std::abs(height), 1e-14);
                ASSERT_LT(norm(found[0].normal - Vec3{0, 0, height > 0 ? 1.0 : -1.0}), 1e-12);
            }
    }
}

TEST(Mesh, OneContactAtEveryPlaceOfAConvexBox) {
    const Mesh mesh = mesh_of(tests::box(4, 8));
    const stats::Stream random(6, 1);
    std::uint64_t at = 0;
    for (int k = 0; k < 400; ++k) {
        Vec3 x = draw(random, at, {5, 5, 5});
        x[2] -= 4;
        const Vec3 clamped = {std::clamp(x[0], -4.0, 4.0), std::clamp(x[1], -4.0, 4.0), std::clamp(x[2], -8.0, 0.0)};
        if (clamped == x) continue;
        const auto found = contacts(mesh, x, 2);
        ASSERT_EQ(found.size(), norm(x - clamped) < 2 ? 1U : 0U);
        if (found.empty()) continue;
        ASSERT_LT(norm(found[0].point - clamped), 1e-15 * 10);
        const int beyond = (x[0] != clamped[0]) + (x[1] != clamped[1]) + (x[2] != clamped[2]);
        ASSERT_EQ(static_cast<int>(found[0].feature), beyond - 1);
    }
    // Inside it, near the corner, three faces.
    EXPECT_EQ(contacts(mesh, {3.5, 3.6, -0.7}, 1).size(), 3U);
}

TEST(Mesh, AConvexEdgeOfManyTrianglesIsOneLongEdge) {
    Soup strips;
    for (int k = 0; k < 9; ++k)  // corners in the middle of the straight edge, others on the two sides of it
        for (const double side : {-1.0, 1.0}) {
            const double from = -1 + (k + 0.3 * (side > 0)) / 4.5, to = from + 1 / 4.5;
            strips =
                tests::joined(strips, tests::quadrilateral({0, from, 0}, {0, to, 0}, {side, to, -1}, {side, from, -1}));
        }
    const Mesh mesh = mesh_of(strips);
    for (int k = 0; k <= 200; ++k) {
        const Vec3 x = {0.0004 * (k % 7), -0.8 + 0.008 * k, 0.05};
        const auto found = contacts(mesh, x, 0.06);
        ASSERT_EQ(found.size(), 1U);
        ASSERT_LT(norm(found[0].point - Vec3{0, x[1], 0}), 1e-15);
    }
}

TEST(Mesh, FindsTrianglesByTheirTrueExtent) {
    // A sliver 1:1000 across everything, a needle, and triangles that differ by a factor of 10^4 in size.
    Soup soup = {{Vec3{-1, -1, -1}, Vec3{1, 1, 1}, Vec3{1, 1.002, 1}},
                 {Vec3{0, 0, 3}, Vec3{0, 0.001, 0}, Vec3{0, 0, 0}}};
    for (int k = 0; k < 300; ++k) {
        const double a = 0.02 * k;
        soup.push_back({Vec3{std::sin(a), std::cos(a), 0}, Vec3{std::sin(a) + 1e-4, std::cos(a), 0},
                        Vec3{std::sin(a), std::cos(a) + 1e-4, 1e-4}});
    }
    const Mesh mesh = mesh_of(soup);
    const stats::Stream random(7, 1);
    std::uint64_t at = 0;
    std::vector<std::uint32_t> near;
    for (int k = 0; k < 500; ++k) {
        const Vec3 x = draw(random, at, {1.3, 1.3, 1.3});
        const double reach = 0.5 * random.uniform(at++);
        mesh.near(x, reach, near);
        std::vector<std::uint32_t> expected;
        for (std::uint32_t t = 0; t < mesh.triangles().size(); ++t)
            if (norm(tests::plain_nearest(mesh.triangles()[t].corner, x) - x) < reach) expected.push_back(t);
        ASSERT_EQ(near, expected);
    }
    for (int k = -99; k <= 99; ++k) {  // spheres that touch nothing but the sliver, anywhere along it
        const double s = k / 100.0;
        EXPECT_FALSE(contacts(mesh, {s + 0.01, s - 0.01, s}, 0.0145).empty()) << s;
    }
}

TEST(Mesh, ASphereMuchLargerThanTheFacetsHasOneContactWithAFlatOrConvexSurface) {
    const Mesh flat = mesh_of(tests::plate(1, 20));
    const auto dome = [](double x, double y) { return -0.1 * (x * x + y * y); };
    const Soup convex = tests::plate(1, 20, dome);
    const Mesh cap = mesh_of(convex);
    for (int k = 0; k < 50; ++k) {
        const Vec3 foot = {0.011 * k - 0.3, 0.3 - 0.013 * k, 0};
        EXPECT_EQ(contacts(flat, foot + Vec3{0, 0, 0.95}, 1).size(), 1U);
        const Vec3 x = foot + Vec3{0, 0, 0.9};
        EXPECT_EQ(contacts(cap, x, 1).size(), tests::plain_contacts(convex, x, 1, 1e-7).size());
    }
}

TEST(Mesh, ConcaveEdgesHaveTwoContactsUnlessTheyAreToBeOne) {
    // Facets of 5.625 degrees in a ring: 2 pi/64.
    const Soup ring = tests::drum(64, 1, 1);
    const Mesh faceted = mesh_of(ring);
    const Mesh smooth = mesh_of(ring, 0.12);
    const double radius = 0.4, overlap = 0.001;
    int twice = 0;
    constexpr int places = 1000;
    for (int k = 0; k < places; ++k) {
        const double angle = 2 * std::numbers::pi * k / places;
        const double r = std::cos(std::numbers::pi / 64) - radius + overlap;
        const Vec3 x = {0.1, r * std::cos(angle), r * std::sin(angle)};
        const auto two = contacts(faceted, x, radius);
        const auto one = contacts(smooth, x, radius);
        ASSERT_LE(two.size(), 2U);
        ASSERT_LE(one.size(), 1U);
        if (two.empty()) continue;
        ASSERT_EQ(one[0].point, two[0].point) << "the nearest stays";
        twice += two.size() > 1 ? 1 : 0;
    }
    EXPECT_GT(twice, 0);
    // A right angle stays two whatever is asked.
    const Soup corner = tests::joined(tests::quadrilateral({-1, -1, 0}, {0, -1, 0}, {0, 1, 0}, {-1, 1, 0}),
                                      tests::quadrilateral({0, -1, 0}, {0, 1, 0}, {0, 1, 1}, {0, -1, 1}));
    EXPECT_EQ(contacts(mesh_of(corner, 0.7), {-0.09, 0.2, 0.095}, 0.1).size(), 2U);
}

TEST(Mesh, GoesOnAcrossPeriodicFaces) {
    // A channel along y, its profile concave, convex and flat, as long as the period; a block at the face besides.
    const std::vector<Vec3> profile = {{-2, 0, 1}, {-1, 0, 0}, {0.2, 0, 0}, {0.6, 0, 0.5}, {1, 0, 0}, {2, 0, 0}};
    const double period = 3;
    Soup soup;
    for (std::size_t k = 0; k + 1 < profile.size(); ++k) {
        const Vec3 along = {0, period, 0};
        soup = tests::joined(
            soup, tests::quadrilateral(profile[k], profile[k + 1], profile[k + 1] + along, profile[k] + along));
    }
    soup.push_back({Vec3{-0.5, 2.9, 0.2}, Vec3{-0.4, 2.95, 0.3}, Vec3{-0.5, 2.98, 0.4}});
    const Domain domain{{-3, 0, -3}, {3, period, 3}, {false, true, false}};
    const Mesh once = mesh_of(soup);
    const Mesh repeated = once.repeated(domain, 0.6);
    Soup long_soup;
    for (const double shift : {-period, 0.0, period})
        for (auto t : soup) {
            for (Vec3& x : t) x[1] += shift;
            long_soup.push_back(t);
        }
    const stats::Stream random(8, 1);
    std::uint64_t at = 0;
    for (int k = 0; k < 600; ++k) {
        Vec3 x = draw(random, at, {2, 1.5, 0.6});
        x[1] += 1.5;
        if (k % 2 == 0) x[1] = k % 4 == 0 ? 0.05 * random.uniform(at++) : period - 0.05 * random.uniform(at++);
        expect_as_plain(long_soup, repeated, x, 0.5);
        if (HasFatalFailure()) return;
        for (const auto& c : contacts(repeated, x, 0.3)) EXPECT_LE(std::abs(c.normal[1]), x[0] < 0 ? 1 : 1e-12);
    }
    // At the face itself the plate has no edge, and without images it has.
    const Vec3 at_face = {1.6, period + 0.01, 0.19};
    ASSERT_EQ(contacts(repeated, at_face, 0.2).size(), 1U);
    EXPECT_EQ(contacts(repeated, at_face, 0.2)[0].normal, (Vec3{0, 0, 1}));
    EXPECT_GT(contacts(once, at_face, 0.2)[0].normal[1], 0.01);
}

TEST(Mesh, KnowsWhatPassesThroughIt) {
    const Soup soup = tests::plate(1, 8, [](double x, double y) { return 0.3 * std::sin(5 * x) * y; });
    const Mesh mesh = mesh_of(soup);
    const stats::Stream random(9, 1);
    std::uint64_t at = 0;
    int through = 0;
    for (int k = 0; k < 500; ++k) {
        const Vec3 from = draw(random, at, {0.9, 0.9, 0.6});
        const Vec3 to = from + draw(random, at, {0.3, 0.3, 0.3});
        // Plainly: along the way the point changes its side of the height field, an odd number of times.
        int crossings = 0;
        for (const auto& t : soup) {
            const Vec3 n = cross(t[1] - t[0], t[2] - t[0]);
            const double before = dot(n, from - t[0]), after = dot(n, to - t[0]);
            if ((before > 0) == (after > 0)) continue;
            const Vec3 hit = from + (before / (before - after)) * (to - from);
            crossings += norm(tests::plain_nearest(t, hit) - hit) < 1e-9 ? 1 : 0;
        }
        ASSERT_EQ(mesh.crossed(from, to).has_value(), crossings > 0);
        through += crossings > 0 ? 1 : 0;
    }
    EXPECT_GT(through, 30);
    // Through edges and vertices too: no gap between triangles.
    for (const auto& t : soup)
        for (const Vec3& hole : {t[0], 0.5 * (t[0] + t[1]), 0.3 * t[1] + 0.7 * t[2]})
            EXPECT_TRUE(mesh.crossed(hole + Vec3{0, 0, 0.4}, hole - Vec3{0, 0, 0.4}));
    EXPECT_FALSE(mesh.crossed({2, 0, 1}, {2, 0, -1}));
    // Of two moves that meet on the surface one crosses.
    const Mesh flat = mesh_of(tests::plate(1, 1));
    const Vec3 above = {0.1, 0.3, 0.1}, on = {0.1, 0.3, 0}, below = {0.1, 0.3, -0.1};
    EXPECT_NE(flat.crossed(above, on).has_value(), flat.crossed(on, below).has_value());
    EXPECT_EQ(flat.crossed(above, on).has_value(), flat.crossed(on, above).has_value());
}

TEST(Mesh, RefusesWhatIsNoSurface) {
    EXPECT_THROW(Mesh(TriangleSurface{}), std::invalid_argument);
    EXPECT_THROW(Mesh({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}}), std::invalid_argument);
    EXPECT_THROW(Mesh({{{0, 0, 0}, {1, 0, 0}, {NAN, 1, 0}}, {{0, 1, 2}}}), std::invalid_argument);
    EXPECT_THROW(mesh_of(tests::plate(1, 1), 1), std::invalid_argument);
}

}  // namespace grainsweep::tests::geometry_mesh_test
