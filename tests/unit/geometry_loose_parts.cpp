// Stray triangles and needles at the ends of a surface; whole surfaces of many kinds have none.
#include "solver/geometry/loose_parts.hpp"
#include "tests/support/surfaces.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace grainsweep::tests::geometry_loose_parts_test {

using geometry::End;
using geometry::Mesh;

constexpr double share = 0.02;
constexpr End lowest{2, false};

Mesh mesh(const Soup& soup) {
    return Mesh(surface_of(soup));
}

auto loose(const Soup& soup) {
    static constexpr auto ends = std::to_array<End>({{2, false}, {0, true}, {0, false}, {1, false}, {1, true}});
    return geometry::loose_triangles(mesh(soup), 1, ends, share);
}

Soup add(Soup a, const Soup& b) {
    return joined(std::move(a), b);
}

/// A prism along y of a profile in x and z, with or without its two ends, in `strips` along y.
Soup prism(const std::vector<std::array<double, 2>>& profile, double from, double to, bool closed, int strips = 1) {
    Soup soup;
    const auto at = [&](std::size_t k, double y) {
        const auto& p = profile[k % profile.size()];
        return Vec3{p[0], y, p[1]};
    };
    for (std::size_t k = 0; k < profile.size(); ++k)
        for (int n = 0; n < strips; ++n) {
            const double a = from + n * (to - from) / strips, b = from + (n + 1) * (to - from) / strips;
            soup = add(soup, quadrilateral(at(k, a), at(k + 1, a), at(k + 1, b), at(k, b)));
        }
    for (std::size_t k = 1; closed && k + 1 < profile.size(); ++k)
        for (const double y : {from, to}) soup.push_back({at(0, y), at(k, y), at(k + 1, y)});
    return soup;
}

std::vector<std::array<double, 2>> rectangle(double x0, double x1, double z0, double z1) {
    return {{x0, z0}, {x1, z0}, {x1, z1}, {x0, z1}};
}

/// A star of n teeth: every other corner on the outer radius.
std::vector<std::array<double, 2>> gear(int teeth, double inner, double outer) {
    std::vector<std::array<double, 2>> profile;
    for (int k = 0; k < 2 * teeth; ++k) {
        const double angle = std::numbers::pi * (k + 0.3) / teeth, radius = k % 2 == 0 ? outer : inner;
        profile.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    return profile;
}

const Soup blade = prism(rectangle(0, 5, 0, 40), 0, 20, true, 4);
const Vec3 corner{0, 10, 0};  // of the blade's lower edge

std::vector<std::pair<std::string, Soup>> whole_tools() {
    const Soup open_blade = prism(rectangle(0, 5, 0, 40), 0, 20, false, 4);
    Soup combs = blade, sheet = plate(20, 8);
    for (int k = 0; k < 10; ++k) {  // shells of their own, sunk into the blade; the third is longest
        const double y = 0.5 + 2 * k, z = k == 2 ? -1.01 : -1;
        combs = add(combs, prism(rectangle(2, 2.2, z, 0.5), y, y + 0.2, true));
    }
    const std::vector<std::array<double, 2>> wedge{{0, 0}, {5, 8}, {5, 40}, {0, 40}};
    Soup seam = prism(rectangle(0, 5, 0.1, 40), 0, 20, true, 4);
    std::erase_if(seam, [](const auto& t) { return t[0][2] == 0.1 && t[1][2] == 0.1 && t[2][2] == 0.1; });
    // A lower end of other strips, so that corners meet sides: T-junctions all along.
    Soup land = prism({{0, 0.1}, {0.1, 0}, {4.9, 0}, {5, 0.1}}, 0, 20, true, 3);
    std::erase_if(land, [](const auto& t) { return t[0][2] == 0.1 && t[1][2] == 0.1 && t[2][2] == 0.1; });
    Soup hanging;  // lip below the middle of a sheet
    hanging = add(sheet, quadrilateral({0, -20, 0}, {0, 20, 0}, {0, 20, -0.5}, {0, -20, -0.5}));
    Soup inclined = prism(wedge, 0, 20, true);
    return {{"blade", blade},
            {"blade open at its ends", open_blade},
            {"wedge", inclined},
            {"shattered plate", shattered_plate(3, 40)},
            {"sheet", sheet},
            {"wavy sheet", plate(20, 8, [](double x, double y) { return std::sin(x) * std::cos(y); })},
            {"sheet with a lip", hanging},
            {"drum", drum(64, 10, 30)},
            {"gear", prism(gear(12, 8, 10), 0, 20, true, 5)},
            {"gear, one tooth longest", prism(gear(61, 9.5, 10), 0, 20, false)},
            {"comb", combs},
            {"two tessellations", add(seam, land)},
            {"every triangle twice", add(blade, blade)},
            {"two bars", add(blade, prism(rectangle(10, 15, -1, 40), 0, 20, true))}};
}

TEST(LooseParts, AreNoneOfWholeTools) {
    for (const auto& [name, soup] : whole_tools()) {
        const auto found = loose(soup);
        EXPECT_FALSE(found) << name << ": " << found->count << " reach " << found->beyond;
        EXPECT_FALSE(geometry::needle_at(mesh(soup), lowest, share)) << name;
    }
}

TEST(LooseParts, HangFromACornerOrAnEdge) {
    const Vec3 tip{0.1, 10.2, -3}, beside{-0.1, 10.1, -3}, behind{0, 9.9, -3};
    const Vec3 next{0, 15, 0};
    const Soup triangle = {{corner, tip, beside}};
    const Soup fin = {{corner, next, {0, 12, -2}}};
    const Soup inside = {{Vec3{2, 9, 0}, {2, 11, 0}, {2, 10, -2}}};  // on a face
    const Soup needle = {{corner, tip, beside}, {corner, beside, behind}, {corner, behind, tip}, {tip, beside, behind}};
    const Soup fin_at_end = {{Vec3{0, 0, 0}, {5, 0, 0}, {2, 0, -2}}};
    for (const auto& [name, stray] : {std::pair("triangle", triangle),
                                      {"both of its sides", add(triangle, triangle)},
                                      {"sliver", {{corner, {1e-3, 10, -3}, {-1e-3, 10, -3}}}},
                                      {"along the edge", {{corner, {0, 0, -3}, {0, 20, -3.1}}}},
                                      {"fin", fin},
                                      {"fin of two sides", add(fin, fin)},
                                      {"fin at an end", fin_at_end},
                                      {"fin on a face", inside},
                                      {"needle", needle},
                                      {"strip", add(triangle, {{tip, beside, {0, 10, -5}}})}}) {
        const auto found = loose(add(blade, stray));
        ASSERT_TRUE(found) << name;
        EXPECT_EQ(found->count, stray.size()) << name;
        double low = 0;
        for (const auto& t : stray)
            for (const Vec3& x : t) low = std::min(low, x[2]);
        EXPECT_DOUBLE_EQ(found->beyond, -low) << name;
        EXPECT_DOUBLE_EQ(found->outermost[2], low) << name;
        EXPECT_EQ(loose(shuffled(add(blade, stray), 5))->count, stray.size()) << name;
    }
    EXPECT_TRUE(loose(add(plate(20, 8), {{Vec3{0, 0, 0}, {0.1, 0.2, -3}, {-0.1, 0.2, -3}}}))) << "below a sheet";
    EXPECT_TRUE(loose(add(prism(gear(12, 8, 10), 0, 20, true), {{Vec3{0, 0, -30}, {0, 1, -30}, {0, 0, -9}}})));
}

TEST(LooseParts, AtTheOtherEndsAndInAHollow) {
    EXPECT_TRUE(loose(add(blade, {{Vec3{5, 10, 0}, {30, 10, 1}, {30, 10.1, 1}}}))) << "in front";
    EXPECT_TRUE(loose(add(blade, {{Vec3{0, 20, 40}, {1, 30, 40}, {1, 30, 39}}}))) << "longer";
    // A closed bar, touching nothing, in the hollow between the two legs of a bridge.
    const std::vector<std::array<double, 2>> bridge{{0, 0},  {5, 0},  {5, 30},  {20, 30},
                                                    {20, 0}, {25, 0}, {25, 40}, {0, 40}};
    Soup hollow = prism(bridge, 0, 20, false);
    EXPECT_FALSE(loose(hollow));
    EXPECT_TRUE(loose(add(hollow, prism(rectangle(10, 10.2, -1, 1), 5, 6, true))));
    EXPECT_FALSE(loose(add(blade, {{Vec3{0, 10, 40}, {0, 10, 20}, {0.1, 10, 20}}}))) << "not outermost";
}

TEST(LooseParts, NeedlesAreDrawnOutCorners) {
    // A block whose lower face has a corner far below it: closed, and no part is loose.
    const auto drawn = [](double depth) {
        Soup soup = box(10, -40);
        std::erase_if(soup, [](const auto& t) { return t[0][2] == 0 && t[1][2] == 0 && t[2][2] == 0; });
        return add(soup, plate(10, 40, [=](double x, double y) { return std::hypot(x, y - 2) < 1e-9 ? -depth : 0.0; }));
    };
    EXPECT_FALSE(loose(drawn(20)));
    const auto needle = geometry::needle_at(mesh(drawn(20)), lowest, share);
    ASSERT_TRUE(needle);
    EXPECT_NEAR(needle->tip[1], 2, 1e-9);
    EXPECT_DOUBLE_EQ(needle->length, 20);
    EXPECT_NEAR(needle->width, std::hypot(0.5, 0.5), 1e-9) << "half of the two squares beside it";
    EXPECT_FALSE(geometry::needle_at(mesh(drawn(2)), lowest, share)) << "a tooth";
    EXPECT_FALSE(geometry::needle_at(mesh(drawn(20)), {2, true}, share));
    const Soup at_border = add(plate(20, 8), {{Vec3{-20, 0, 0}, {-20, 5, 0}, {-20, 2.5, -30}}});
    EXPECT_FALSE(loose(at_border)) << "joined to a sheet's free edge";
    EXPECT_TRUE(geometry::needle_at(mesh(at_border), lowest, 0.05));
}

}  // namespace grainsweep::tests::geometry_loose_parts_test
