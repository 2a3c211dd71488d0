// Hypervolume of a front, and its expected growth against a sum over a grid.
#include "stats/hypervolume.hpp"
#include "stats/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace grainsweep::tests::stats_hypervolume_test {

using namespace stats;
using Point = std::array<double, 2>;

Hypervolume of(const std::vector<Point>& points, Point reference, std::array<bool, 2> maximise) {
    Hypervolume volume(reference, maximise);
    for (const auto& point : points) volume.add(point);
    return volume;
}

TEST(Hypervolume, IsTheAreaThatAFrontDominates) {
    const std::vector<Point> points = {{1, 3}, {2, 1}, {3, 0.5}};
    EXPECT_DOUBLE_EQ(of(points, {4, 4}, {false, false}).value(), 1 * 1 + 1 * 3 + 1 * 3.5);
    EXPECT_DOUBLE_EQ(of({{2, 1}, {3, 0.5}, {1, 3}}, {4, 4}, {false, false}).value(), 7.5) << "in any order";
    EXPECT_DOUBLE_EQ(of({}, {4, 4}, {false, false}).value(), 0);
    EXPECT_DOUBLE_EQ(of({{5, 1}, {1, 4}}, {4, 4}, {false, false}).value(), 0) << "no better than the reference";
    auto beaten = points;
    beaten.insert(beaten.end(), {{2, 3}, {3, 1}, {2, 1}, {1, 3.5}});
    EXPECT_DOUBLE_EQ(of(beaten, {4, 4}, {false, false}).value(), 7.5);
    EXPECT_DOUBLE_EQ(of({{-1, 3}, {-2, 1}, {-3, 0.5}}, {-4, 4}, {true, false}).value(), 7.5) << "one is maximised";
}

TEST(Hypervolume, FurtherPointsAddAtMostTheSteps) {
    EXPECT_DOUBLE_EQ(of({{1, 3}, {2, 1}, {3, 0.5}}, {4, 4}, {false, false}).between_points(), 1 * 2 + 1 * 0.5);
    EXPECT_EQ(of({{1, 3}}, {4, 4}, {false, false}).between_points(), 0);
}

TEST(Hypervolume, OfRandomPointsIsTheirShareOfAGrid) {
    const Stream stream(1, 1);
    std::vector<Point> points;
    for (std::uint64_t i = 0; i < 30; ++i) points.push_back({stream.uniform(2 * i), stream.uniform(2 * i + 1)});
    const auto volume = of(points, {0.1, 0.8}, {true, false});
    constexpr int n = 1000;
    int inside = 0;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const double a = 0.1 + 0.9 * (i + 0.5) / n, b = 0.8 * (j + 0.5) / n;
            for (const auto& point : points)
                if (point[0] > a && point[1] < b) {
                    ++inside;
                    break;
                }
        }
    EXPECT_NEAR(volume.value(), 0.9 * 0.8 * inside / (n * n), 2e-3);
}

TEST(Hypervolume, ItsExpectedGainIsTheIntegralOfTheGain) {
    const std::vector<Point> front = {{1, 3}, {2, 1}, {3, 0.5}};
    const Point reference = {4, 4};
    const auto volume = of(front, reference, {false, false});
    for (const auto& [m, s] : {std::pair{Point{1.5, 1.5}, Point{0.5, 0.8}},
                               {Point{3, 3}, Point{1, 0.3}},
                               {Point{0, 0}, Point{0.2, 0.2}},
                               {Point{5, 5}, Point{1, 1}}}) {
        constexpr int n = 400;
        constexpr double widest = 6;
        double sum = 0;
        for (int i = 0; i < n; ++i)
            for (int j = 0; j < n; ++j) {
                const double u = widest * ((2 * i + 1.0) / n - 1), v = widest * ((2 * j + 1.0) / n - 1);
                auto with = volume;
                with.add({m[0] + s[0] * u, m[1] + s[1] * v});
                sum += (with.value() - volume.value()) * std::exp(-0.5 * (u * u + v * v));
            }
        sum *= std::pow(2 * widest / n, 2) / (2 * M_PI);
        const double gain = volume.expected_gain({m[0], s[0], 0}, {m[1], s[1], 0});
        EXPECT_NEAR(gain, sum, 1e-3 * sum + 1e-6);
        const auto mirrored = of({{-1, 3}, {-2, 1}, {-3, 0.5}}, {-4, 4}, {true, false});
        EXPECT_DOUBLE_EQ(mirrored.expected_gain({-m[0], s[0], 0}, {m[1], s[1], 0}), gain);
    }
}

TEST(Hypervolume, AKnownPointGainsWhatItAdds) {
    const auto volume = of({{1, 3}, {2, 1}}, {4, 4}, {false, false});
    const auto gain = [&](double a, double b) { return volume.expected_gain({a, 0, 0}, {b, 0, 0}); };
    EXPECT_DOUBLE_EQ(gain(1.5, 0.5), 0.5 * 2.5 + 2 * 0.5);
    EXPECT_DOUBLE_EQ(gain(2.5, 2), 0);
    EXPECT_DOUBLE_EQ(gain(0, 5), 0) << "worse than the reference";
    // One is known: the other's expected improvement times the width.
    const double z = 1.0 / 0.5, phi = std::exp(-z * z / 2) / std::sqrt(2 * M_PI), cdf = 0.5 * std::erfc(-z / M_SQRT2);
    const auto empty = of({}, {4, 4}, {false, false});
    EXPECT_NEAR(empty.expected_gain({1, 0, 0}, {3, 0.5, 0}), 3 * (1 * cdf + 0.5 * phi), 1e-12);
}

}  // namespace grainsweep::tests::stats_hypervolume_test
