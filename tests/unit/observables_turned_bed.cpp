// What is measured of a bed in a drum, on states whose answers are known exactly.
#include "solver/observables/turned_bed.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace grainsweep::tests::observables_turned_bed_test {

using namespace observables;

constexpr double degree = std::numbers::pi / 180;

/// Points on a fine lattice below the line z = height + slope x in a drum, as tiny spheres that fill a fraction.
dem::State segment(double radius, double length, double slope, double height, double pitch, double fraction) {
    dem::State state;
    const double r = std::cbrt(fraction * pitch * pitch * length * 3 / (4 * std::numbers::pi));
    const auto n = static_cast<int>(radius / pitch);
    for (int i = -n; i < n; ++i)
        for (int j = -n; j < n; ++j) {
            const double x = (i + 0.5) * pitch, z = (j + 0.5) * pitch;
            if (std::hypot(x, z) > radius || z > height + slope * x) continue;
            state.id.push_back(static_cast<std::int32_t>(state.id.size()));
            state.position.push_back({x, 0, z});
            state.velocity.push_back({});
            state.angular_velocity.push_back({});
            state.radius.push_back(r);
            state.mobile.push_back(1);
        }
    return state;
}

/// Returns all spheres projected to the plane across the drum.
Section section_of(const dem::State& state) {
    const SectionView view;
    Section section;
    for (std::size_t i = 0; i < state.position.size(); ++i) section.push_back(view.sphere(state, i));
    return section;
}

TEST(LineFit, IsExactOnALineAndLeastInBetween) {
    const std::vector<std::array<double, 2>> straight = {{-2, 5}, {1, -1}, {4, -7}};
    const Line line = fitted_line(straight);
    EXPECT_DOUBLE_EQ(line.slope, -2);
    EXPECT_DOUBLE_EQ(line.height, 1);
    EXPECT_NEAR(line.residual, 0, 1e-15);
    // Of (0, 0), (1, 1), (2, 0): the mean height, slope 0, residuals 1/3, 2/3, 1/3.
    const std::vector<std::array<double, 2>> bent = {{0, 0}, {1, 1}, {2, 0}};
    EXPECT_NEAR(fitted_line(bent).slope, 0, 1e-15);
    EXPECT_NEAR(fitted_line(bent).residual, std::sqrt(2.0) / 3, 1e-15);
    EXPECT_TRUE(std::isnan(fitted_line(std::vector<std::array<double, 2>>{{1, 2}, {1, 3}}).slope));
    EXPECT_TRUE(std::isnan(fitted_line({}).height));
    std::vector<std::array<double, 2>> level;
    for (int k = 0; k < 7; ++k) level.push_back({0.1 * k * k, 0.0123});
    EXPECT_EQ(fitted_line(level).slope, 0) << "a rate of nothing is 0, not -6.6e-35";
    EXPECT_EQ(fitted_line(level).height, 0.0123);
    EXPECT_EQ(fitted_line(level).residual, 0);
}

TEST(TurnedBed, TheSurfaceOfAnEvenBedIsItsLine) {
    const double radius = 0.075, length = 0.03, diameter = 0.005;
    for (const double angle : {0.0, 25.0, 37.0}) {
        SolidFraction solid(radius, length, diameter);
        const double slope = -std::tan(angle * degree);
        for (const double up : {-1e-4, 1e-4})
            solid.add(section_of(segment(radius, length, slope, -0.011 + up, 1e-4, 0.58)));
        const Line line = solid.surface_line(radius);
        // Within a cell that the surface cuts the fraction falls over a cell's height: the level 0.3 of 0.58 lies
        // within a few hundredths of a cell of the line, wherever it cuts.
        EXPECT_NEAR(std::atan(-line.slope) / degree, angle, 0.35);
        EXPECT_NEAR(line.height, -0.011, 0.1 * diameter);
        const auto mean = solid.mean();
        EXPECT_NEAR(mean[solid.grid().number(15, 5)], 0.58, 1e-9);
    }
    const SolidFraction none(radius, length, diameter);
    EXPECT_TRUE(std::isnan(none.surface_line(radius).slope));
}

TEST(TurnedBed, TheFlowIsReadDownTheLine) {
    // u = u0 (1 - depth/h) down a line of 30 degrees, at an angle that no cell knows.
    const double radius = 0.075, diameter = 0.005, u0 = 0.4, depth_of_rest = 4.3 * diameter;
    const double slope = -std::tan(30 * degree), height = -0.01;
    dem::State state = segment(radius, 0.03, slope, height, 2e-4, 0.5);
    for (std::size_t i = 0; i < state.position.size(); ++i) {
        const auto& x = state.position[i];
        const double depth = (height + slope * x[0] - x[2]) * std::cos(30 * degree);
        const double u = u0 * (1 - depth / depth_of_rest);
        state.velocity[i] = {u * std::cos(30 * degree), 7, -u * std::sin(30 * degree)};
    }
    SectionFlow flow(radius, diameter);
    flow.add(section_of(state));
    const auto below = flow.below({slope, height, 0});
    EXPECT_NEAR(below.depth, 4.3, 0.02);
    EXPECT_NEAR(below.surface_speed / (u0 * (1 - 0.5 / 4.3)), 1, 5e-3);
    EXPECT_TRUE(std::isnan(SectionFlow(radius, diameter).below({slope, height, 0}).surface_speed));
    EXPECT_TRUE(std::isnan(flow.below({}).depth));
}

TEST(TurnedBed, CoverCountsTheFramesThatHideACell) {
    dem::State one;
    one.id = {0}, one.position = {{0.02, 0.5, -0.03}}, one.velocity = {{}}, one.radius = {0.01}, one.mobile = {1};
    Cover cover(0.1, 1e-3);
    EXPECT_EQ(cover.grid().count, 200);
    cover.add(section_of(one));
    one.position[0][0] = 0.025;
    cover.add(section_of(one));
    const auto share = cover.share();
    double area = 0;
    for (const double s : share) area += s * 1e-6;
    EXPECT_NEAR(area / (std::numbers::pi * 1e-4), 1, 0.02) << "a disc in each frame";
    const auto at = [&](double x, double z) {
        return share[cover.grid().number(cover.grid().column(x), cover.grid().column(z))];
    };
    EXPECT_EQ(at(0.0225, -0.0295), 1);
    EXPECT_EQ(at(0.0115, -0.0295), 0.5);
    EXPECT_EQ(at(0.0345, -0.0295), 0.5);
    EXPECT_EQ(at(0.05, 0.03), 0);
    // The upper edge of the disc that is in both frames, from above.
    const auto edge = falling_through(cover.grid(), share, 0.75, 0.1);
    ASSERT_FALSE(edge.empty());
    for (const auto& [x, z] : edge) {
        const double dx = std::max(std::abs(x - 0.02), std::abs(x - 0.025));
        EXPECT_NEAR(z, -0.03 + std::sqrt(1e-4 - dx * dx), 1.3e-3 + 1e-3 * dx / std::sqrt(1e-4 - dx * dx));
    }
}

TEST(TurnedBed, CellsLieAboutTheAxis) {
    const SectionGrid even(0.075, 0.005);
    EXPECT_EQ(even.count, 30);
    EXPECT_DOUBLE_EQ(even.centre(15), 0.0025);
    EXPECT_EQ(even.column(0.0025), 15);
    EXPECT_EQ(even.column(-0.0001), 14);
    EXPECT_EQ(SectionGrid(0.042, 0.084 / 406).count, 406) << "the picture of a drum";
    EXPECT_EQ(SectionGrid(0.075, 0.02).count, 8);
}

TEST(TurnedBed, TheWallLayerIsWhatTouchesTheLowerHalf) {
    const double radius = 0.1, r = 0.005, speed = 3;
    dem::State state;
    const auto add = [&](double angle, double from_axis, double share) {
        state.position.push_back({from_axis * std::cos(angle), 0, from_axis * std::sin(angle)});
        // w x r about +y is (w z, 0, -w x).
        state.velocity.push_back(
            {share * speed * state.position.back()[2], 1, -share * speed * state.position.back()[0]});
        state.radius.push_back(r);
        state.id.push_back(static_cast<std::int32_t>(state.id.size()));
    };
    add(-1.0, radius - r, 1);
    add(-2.0, radius - r - 0.05 * 2 * r, 0.5);
    add(-1.5, radius - 3 * r, 9);  // not at the wall
    add(1.0, radius - r, 9);       // in the upper half
    const auto seen = wall_layer_speed(section_of(state), radius, 2 * r);
    ASSERT_TRUE(seen);
    EXPECT_NEAR(*seen, speed * (radius - r + 0.5 * (radius - 1.1 * r)) / 2, 1e-12);
    EXPECT_FALSE(wall_layer_speed(Section{}, radius, 2 * r));
}

}  // namespace grainsweep::tests::observables_turned_bed_test
