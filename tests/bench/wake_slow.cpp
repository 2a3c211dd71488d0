// How fast a lone sphere settles in a two-way coupled box, over grids, kernels and distances to a wall, along it and
// towards it: two minutes of processor time, slow_wake. No cell is wider than the kernel.
#include "tests/support/lone_sphere.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace grainsweep::tests::wake_slow_test {

using namespace lone_sphere;

TEST(SlowOwnWake, SettlingIsStokesOverGridsKernelsAndWalls) {
    double largest_kept = 0, largest = 0;
    for (const auto& grid : {cube(20), cube(28, 1.5), cube(36)})
        for (const double width : {0.06, 0.1})
            for (const double z : {0.02, 0.05, 0.15, 0.5})
                for (const int axis : {0, 1}) {
                    const Place at{grid, width, {-0.497 + z, 0.011, 0.007}, axis};
                    const double kept = settling<Kept>(at) - 1, subtracted = settling<Subtracted>(at) - 1;
                    EXPECT_LT(std::abs(subtracted), 0.01)
                        << grid.cells(0) << " cells, width " << width << ", z " << z << ", axis " << axis;
                    largest_kept = std::max(largest_kept, kept);
                    largest = std::max(largest, std::abs(subtracted));
                }
    std::printf("too fast by at most %.4f with the own wake, off by at most %.4f without\n", largest_kept, largest);
    EXPECT_GT(largest_kept, 0.03);
}

}  // namespace grainsweep::tests::wake_slow_test
