// Units of figures for print, and the cells of their maps.
#include "sweep/report/print_axes.hpp"
#include "sweep/study/effects.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace grainsweep::tests::report_print_axes_test {

using report::printed_unit;
using report::quantity_of;
using testing::DoubleEq;
using testing::ElementsAre;

TEST(PrintAxes, UnitsHaveRaisedPowers) {
    EXPECT_EQ(printed_unit("J/m3"), "J/m³");
    EXPECT_EQ(printed_unit("m/s2"), "m/s²");
    EXPECT_EQ(printed_unit("kg m-3"), "kg m⁻³");
    EXPECT_EQ(printed_unit("L^2/alpha"), "L²/α");
    EXPECT_EQ(printed_unit("1"), "");
    EXPECT_EQ(printed_unit("sqrt(2 L/g)"), "sqrt(2 L/g)");
}

TEST(PrintAxes, OnePrefixBringsTheNumbersNearOne) {
    const auto gap = quantity_of("gap", "m", 0.0036);
    EXPECT_EQ(gap.title, "gap (mm)");
    EXPECT_DOUBLE_EQ(gap.of(0.0036), 3.6);
    EXPECT_EQ(quantity_of("diameter", "m", 60e-6).title, "diameter (µm)");
    EXPECT_EQ(quantity_of("cohesion", "J/m3", 35'000).title, "cohesion (kJ/m³)");
    EXPECT_EQ(quantity_of("speed", "m/s", 1.5).title, "speed (m/s)");
    EXPECT_EQ(quantity_of("packing_fraction", "1", 0.6).title, "packing fraction");
    // No prefix stands before these.
    EXPECT_EQ(quantity_of("area", "m2", 3e-6).title, "area (10⁻⁶ m²)");
    EXPECT_EQ(quantity_of("share", "1", 3e-5).title, "share (10⁻⁶)");
    EXPECT_DOUBLE_EQ(quantity_of("share", "1", 3e-5).of(3e-5), 30);
    EXPECT_EQ(quantity_of("mfr", "1", 0.0).title, "mfr");
}

TEST(PrintAxes, ALogarithmicRangeStaysPositive) {
    const auto axis = report::number_axis({"x", 1}, {0.001, 10}, true, 0.05);
    EXPECT_TRUE(axis.log);
    EXPECT_GT(axis.low, 0);
    EXPECT_NEAR(axis.high / 10, 0.001 / axis.low, 1e-12);
}

study::FactorColumn factor_of(std::vector<double> values, const std::vector<Value>& levels = {}) {
    study::FactorColumn factor{{"a", campaign::Between{0, 1}}};
    if (!levels.empty()) factor.range = campaign::Levels{levels};
    factor.seen = levels;
    factor.values = std::move(values);
    return factor;
}

TEST(CellMeans, LevelsAndDistinctValuesAreCellsOfTheirOwn) {
    const study::ResponseColumn response{"y", "1", "", {1, 3, 5, std::nan(""), 9}};
    const auto cells =
        study::cell_means(factor_of({0, 0, 1, 1, 1}, {"p", "q"}), factor_of({0.2, 0.2, 0.2, 0.6, 0.6}), response);
    EXPECT_THAT(cells.x_edges, ElementsAre(-0.5, 0.5, 1.5));
    EXPECT_THAT(cells.y_edges, ElementsAre(DoubleEq(0.0), DoubleEq(0.4), DoubleEq(0.8)));
    ASSERT_EQ(cells.means.size(), 4U);
    EXPECT_EQ(cells.means[0], 2) << "mean of 1 and 3";
    EXPECT_EQ(cells.means[1], 5);
    EXPECT_TRUE(std::isnan(cells.means[2])) << "no case there";
    EXPECT_EQ(cells.means[3], 9) << "the case without a value does not count";
}

TEST(CellMeans, DivideARangeEvenly) {
    std::vector<double> x, y, values;
    for (int k = 0; k < 200; ++k) {
        x.push_back((k + 0.5) / 200);
        y.push_back(std::fmod(0.618034 * k, 1.0));
        values.push_back(x.back());
    }
    const auto cells = study::cell_means(factor_of(x), factor_of(y), {"y", "1", "", values});
    ASSERT_EQ(cells.x_edges.size(), 6U) << "sqrt(200/8) = 5 cells";
    EXPECT_DOUBLE_EQ(cells.x_edges[1], 0.2);
    for (std::size_t k = 0; k < cells.means.size(); ++k)
        EXPECT_NEAR(cells.means[k], 0.1 + 0.2 * static_cast<double>(k % 5), 0.05);
}

}  // namespace grainsweep::tests::report_print_axes_test
