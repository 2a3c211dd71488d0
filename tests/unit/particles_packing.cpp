// Packings on a small scale, near pairs, and the text a user brings.
#include "solver/particles/packing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <stdexcept>

#include "solver/particles/near_pairs.hpp"
#include "stats/random.hpp"

namespace grainsweep::tests::particles_packing_test {

using namespace particles;

using Point = std::array<double, 3>;

std::string refusal(const std::string& csv, double edge = 10) {
    try {
        (void)read_packing(csv, edge);
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return "";
}

TEST(NearPairs, AreThoseOfAllPairs) {
    const stats::Stream draws(1, 1);
    std::vector<Point> points;
    for (std::uint64_t i = 0; i < 300; ++i) {
        Point x{};
        for (std::size_t k = 0; k < 3; ++k) x[k] = -3 + 7 * draws.uniform(3 * i + k) * static_cast<double>(k + 1);
        points.push_back(x);
    }
    points.push_back({1e6, -1e6, 0});  // far away: the grid must not grow with it
    for (const double range : {0.3, 1.0, 40.0}) {
        std::map<std::pair<std::size_t, std::size_t>, double> found;
        for_each_near_pair(points, range, [&](std::size_t i, std::size_t j, double r) {
            EXPECT_LT(i, j);
            EXPECT_TRUE(found.emplace(std::pair(i, j), r).second) << "met twice";
        });
        std::size_t expected = 0;
        for (std::size_t i = 0; i < points.size(); ++i)
            for (std::size_t j = i + 1; j < points.size(); ++j) {
                const double r =
                    std::sqrt(std::pow(points[i][0] - points[j][0], 2) + std::pow(points[i][1] - points[j][1], 2) +
                              std::pow(points[i][2] - points[j][2], 2));
                if (r >= range) continue;
                ++expected;
                ASSERT_TRUE(found.contains({i, j})) << range;
                EXPECT_DOUBLE_EQ(found.at({i, j}), r);
            }
        EXPECT_EQ(found.size(), expected);
    }
}

TEST(Packing, IsAFunctionOfItsRequest) {
    const PackingRequest request{5, 0.5, 7, 2e-5};
    const Packing one = random_close_packing(request), again = random_close_packing(request);
    EXPECT_EQ(one.positions, again.positions);
    EXPECT_EQ(static_cast<std::int64_t>(one.positions.size()), sphere_count(request));
    EXPECT_NE(one.positions, random_close_packing({5, 0.5, 8, 2e-5}).positions);
}

TEST(Packing, LeavesNoOverlapAcrossThePeriodicFaces) {
    const Packing packing = random_close_packing({6, 0.6, 3, 2e-5});
    double largest = 0;
    for (std::size_t i = 0; i < packing.positions.size(); ++i)
        for (std::size_t j = i + 1; j < packing.positions.size(); ++j) {
            double square = 0;
            for (std::size_t k = 0; k < 3; ++k) {
                double d = packing.positions[i][k] - packing.positions[j][k];
                d -= 6 * std::round(d / 6);
                square += d * d;
            }
            largest = std::max(largest, 1 - std::sqrt(square));
        }
    EXPECT_LT(largest, 2e-5);
    EXPECT_NEAR(largest, packing.largest_overlap, 1e-12);
}

TEST(Packing, RefusesWhatCannotBePacked) {
    EXPECT_THROW((void)random_close_packing({4, 0.6, 1, 2e-5}), std::invalid_argument);
    EXPECT_THROW((void)random_close_packing({20, 0.7, 1, 2e-5}), std::invalid_argument);
    EXPECT_THROW((void)random_close_packing({20, 0.6, 1, 1e-9}), std::invalid_argument);
}

TEST(Packing, TravelsAsBytesBitForBit) {
    const Packing packing = random_close_packing({5, 0.3, 1, 2e-5});
    const auto bytes = encode(packing);
    const Packing back = decode_packing(bytes);
    EXPECT_EQ(back.positions, packing.positions);
    EXPECT_EQ(back.edge, packing.edge);
    EXPECT_EQ(back.largest_overlap, packing.largest_overlap);
    EXPECT_EQ(back.iterations, packing.iterations);
    EXPECT_THROW((void)decode_packing(std::span(bytes).first(bytes.size() - 1)), std::invalid_argument);
    EXPECT_THROW((void)decode_packing(std::span(bytes).first(10)), std::invalid_argument);
}

TEST(Packing, KeyNamesAllThatDeterminesIt) {
    const std::string key = packing_key({20, 0.62, 1, 2e-5});
    EXPECT_EQ(key, "packing\nalgorithm=1\nedge=20\nfraction=0.62\nseed=1\ntolerance=2e-05\n");
    EXPECT_NE(key, packing_key({20, 0.62, 2, 2e-5}));
}

TEST(PackingText, IsReadAsWritten) {
    const Packing packing = read_packing("x,y,z\n0.5,0.5,0.5\r\n 1.5 , 0.5,5e-1\n\n9.25,9.5,0\n", 10);
    ASSERT_EQ(packing.positions.size(), 3U);
    EXPECT_EQ(packing.positions[1], (Point{1.5, 0.5, 0.5}));
    EXPECT_EQ(packing.positions[2], (Point{9.25, 9.5, 0}));
    EXPECT_EQ(packing.largest_overlap, 0);
    EXPECT_NEAR(read_packing("x,y,z\n0.5,0.5,0.5\n1.49,0.5,0.5", 10).largest_overlap, 0.01, 1e-15);
}

TEST(PackingText, WrongLinesAreNamed) {
    using testing::HasSubstr;
    EXPECT_THAT(refusal("1,2,3\n"), HasSubstr("line 1: the header must be x,y,z, not '1,2,3'"));
    EXPECT_THAT(refusal("x,y,z\n1,2\n"), HasSubstr("line 2: '1,2' is not three numbers"));
    EXPECT_THAT(refusal("x,y,z\n1,2,3\n1,2,3,4\n"), HasSubstr("line 3: '1,2,3,4' is not three numbers"));
    EXPECT_THAT(refusal("x,y,z\n1,2,nan\n"), HasSubstr("line 2: a centre at nan is outside"));
    EXPECT_THAT(refusal("x,y,z\n1,2,10\n"), HasSubstr("outside the cube of 10 diameters"));
    EXPECT_THAT(refusal("x,y,z\n1,2,3\n1,2,3.5\n"), HasSubstr("line 3: the sphere overlaps that of line 2 by 0.5"));
    EXPECT_THAT(refusal("x,y,z\n"), HasSubstr("there is no sphere"));
    EXPECT_THAT(refusal(""), HasSubstr("there is no sphere"));
}

}  // namespace grainsweep::tests::particles_packing_test
