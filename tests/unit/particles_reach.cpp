// Frozen spheres that no mobile one can ever touch.
#include "solver/particles/reach.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grainsweep::tests::particles_reach_test {

using namespace particles;

using Point = std::array<double, 3>;

/// A block of touching spheres on a cubic lattice, m^3 of them.
std::vector<Point> lattice(int m) {
    std::vector<Point> spheres;
    for (int k = 0; k < m; ++k)
        for (int j = 0; j < m; ++j)
            for (int i = 0; i < m; ++i)
                spheres.push_back({static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)});
    return spheres;
}

bool interior(const Point& x, int m) {
    bool inside = true;
    for (const double c : x) inside = inside && c > 0.5 && c < m - 1.5;
    return inside;
}

TEST(Reach, OnlyTheSkinOfABlockIsTouched) {
    // The widest hole between four spheres of a cubic lattice has radius sqrt(2)/2: a centre kept 0.9 away
    // from each cannot pass it, and one that touches the outside comes no nearer than 1 to the second layer:
    // over the middle of a face of four its distance to the layer below is 1 + sqrt(0.9^2 - 1/2) > 1.
    const auto spheres = lattice(6);
    const auto touched = reachable(spheres, {}, 0.9);
    for (std::size_t i = 0; i < spheres.size(); ++i)
        EXPECT_EQ(touched[i], !interior(spheres[i], 6)) << spheres[i][0] << spheres[i][1] << spheres[i][2];
}

TEST(Reach, AMobileSphereInsideReachesItsCage) {
    auto spheres = lattice(8);
    std::erase(spheres, Point{4, 4, 4});
    const auto without = reachable(spheres, {}, 0.9);
    const auto with = reachable(spheres, std::vector<Point>{{4, 4, 4}}, 0.9);
    for (std::size_t i = 0; i < spheres.size(); ++i) {
        const double r = std::hypot(spheres[i][0] - 4, spheres[i][1] - 4, spheres[i][2] - 4);
        EXPECT_EQ(without[i], !interior(spheres[i], 8));
        // It can lean on the six neighbours by 0.1 and then just not touch those at sqrt 2.
        if (r < 1.1) {
            EXPECT_TRUE(with[i]);
        } else if (r > 1.5 && interior(spheres[i], 8)) {
            EXPECT_FALSE(with[i]) << r;
        }
    }
}

TEST(Reach, AnOpenChannelLetsItIn) {
    // Take out a column: everything along it is within a diameter of the channel.
    auto spheres = lattice(7);
    std::erase_if(spheres, [](const Point& x) { return x[0] == 3 && x[1] == 3; });
    const auto touched = reachable(spheres, {}, 0.9);
    for (std::size_t i = 0; i < spheres.size(); ++i)
        if (std::abs(spheres[i][0] - 3) + std::abs(spheres[i][1] - 3) == 1) {
            EXPECT_TRUE(touched[i]);
        }
    // If no overlap were excluded, every hole would be a way in.
    const auto soft = reachable(lattice(6), {}, 0.5);
    for (const bool t : soft) EXPECT_TRUE(t);
}

TEST(Reach, NothingFrozenNothingTouched) {
    EXPECT_TRUE(reachable({}, {}, 0.9).empty());
}

}  // namespace grainsweep::tests::particles_reach_test
