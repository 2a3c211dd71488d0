// When the axis of a response in a figure is logarithmic.
#include "sweep/campaign/input_error.hpp"
#include "sweep/plot/ticks.hpp"
#include "sweep/report/figures.hpp"
#include "sweep/report/print_axes.hpp"
#include "tests/support/study.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <variant>

namespace grainsweep::tests::report_log_axis_test {

using namespace report;
using testing::HasSubstr;

struct LogAxis : Study {
    /// A figure of the response `of`.
    plot::Figure figure(const Formula& of, std::string_view name, std::optional<bool> log = {}) {
        answer_by(store, halton("c", 256), of);
        const auto responses = ask("c");
        return figure_named({store, responses, responses.observable("y"), {}, {}, {}, log}, name);
    }
};

/// Three decades.
double wide(const Inputs& inputs) {
    return std::exp(7 * input(inputs, "x1"));
}

TEST(LogAxisRule, NeedsPositiveNumbersOverTwoDecades) {
    EXPECT_TRUE(spans_decades({1e-6, 1.1e-4}));
    EXPECT_FALSE(spans_decades({1e-6, 9.9e-5}));
    EXPECT_FALSE(spans_decades({0, 1}));
    EXPECT_FALSE(spans_decades({-1, 1000}));
}

TEST(LogAxisRule, EndsAreNumbersWhereTheRangeIsThatOfADouble) {
    for (const auto& range : {NumberRange{1e-313, 1}, {1e-310, 1e-2}, {1e-300, 1e300}, {1, 1e307}}) {
        const auto axis = number_axis({"y", 1}, range, true);
        EXPECT_GT(axis.low, 0) << range.low;
        EXPECT_LE(axis.low, range.low);
        EXPECT_TRUE(std::isfinite(axis.high)) << range.high;
        EXPECT_GE(axis.high, range.high);
        const auto ticks = plot::ticks_of(axis, 7);
        EXPECT_GE(ticks.size(), 2U);
        EXPECT_LE(ticks.size(), 12U);
        EXPECT_TRUE(plot::minor_ticks(axis).empty());
    }
}

TEST_F(LogAxis, IsTakenWhereTheResponseSpansDecades) {
    for (const char* name : {"distribution", "cases", "against:x1", "map"}) {
        const auto drawn = figure(wide, name);
        const auto& panel = drawn.panels.front();
        const std::string of = name;
        const auto& axis = of == "distribution" ? panel.x : of == "map" ? panel.scale.value() : panel.y;
        EXPECT_TRUE(axis.log) << name;
        EXPECT_GT(axis.low, 0) << name;
    }
    for (const char* name : {"distribution", "against:x1"}) {
        const auto drawn = figure(wide, name, false);
        const auto& panel = drawn.panels.front();
        EXPECT_FALSE((std::string(name) == "distribution" ? panel.x : panel.y).log) << "linear, as requested";
    }
}

TEST_F(LogAxis, OfADistributionHasBarsOfEqualWidthOnIt) {
    const auto drawn = figure(wide, "distribution");
    const auto& bars = std::get<plot::Bars>(drawn.panels.front().marks.front());
    const auto width = [&](std::size_t k) { return std::log(bars.to[k] / bars.from[k]); };
    for (std::size_t k = 1; k < bars.from.size(); ++k) EXPECT_NEAR(width(k), width(0), 1e-9);
    for (const double count : bars.length) EXPECT_NEAR(count, 256.0 / static_cast<double>(bars.length.size()), 6);
}

TEST_F(LogAxis, IsTakenOnRequestIfItCanBe) {
    EXPECT_TRUE(figure(linear, "against:x1", true).panels.front().y.log) << "1 to 4";
    EXPECT_FALSE(figure(linear, "against:x1").panels.front().y.log);
    EXPECT_THROW((void)figure(linear, "sensitivity", true), campaign::InputError) << "it has no such axis";
}

TEST_F(LogAxis, IsRefusedBelowZero) {
    try {
        (void)figure([](const Inputs& inputs) { return input(inputs, "x1") - 0.5; }, "against:x1", true);
        FAIL();
    } catch (const campaign::InputError& wrong) {
        EXPECT_THAT(wrong.what(), HasSubstr("--axis: got 'log'; what the figure shows of 'y' reaches down to -0.4"));
    }
}

}  // namespace grainsweep::tests::report_log_axis_test
