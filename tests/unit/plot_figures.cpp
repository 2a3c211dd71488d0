// Figures for print: ticks, labels that do not touch, files without dates.
#include "sweep/plot/axes.hpp"
#include "sweep/plot/plot.hpp"
#include "sweep/plot/ticks.hpp"

#include <cairo.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>
#include <regex>
#include <string>
#include <utility>
#include <vector>

namespace grainsweep::tests::plot_figures_test {

using namespace plot;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

std::vector<std::string> labels(const std::vector<Tick>& ticks) {
    std::vector<std::string> texts;
    for (const auto& tick : ticks) texts.push_back(tick.label);
    return texts;
}

TEST(PlotTicks, AreRoundNumbersWithOneNumberOfDecimals) {
    EXPECT_THAT(labels(round_ticks(0, 1, 5)), ElementsAre("0.0", "0.2", "0.4", "0.6", "0.8", "1.0"));
    EXPECT_THAT(labels(round_ticks(1.03, 7.9, 7)), ElementsAre("2", "3", "4", "5", "6", "7"));
    EXPECT_THAT(labels(round_ticks(-30, 30, 4)), ElementsAre("−20", "0", "20"));
    EXPECT_THAT(labels(round_ticks(5, 5, 4)), ElementsAre("5"));
}

TEST(PlotTicks, OfALogarithmicAxisArePowersOfTenWhereThereAreSome) {
    EXPECT_THAT(labels(log_ticks(0.1, 1000, 7)), ElementsAre("0.1", "1", "10", "100", "1000"));
    EXPECT_THAT(labels(log_ticks(1e-6, 1e-3, 7)), ElementsAre("10⁻⁶", "10⁻⁵", "10⁻⁴", "0.001"));
    EXPECT_THAT(labels(log_ticks(2, 30, 7)), ElementsAre("2", "5", "10", "20"));
    EXPECT_THAT(labels(log_ticks(20, 60, 5)), ElementsAre("20", "30", "40", "50", "60"));
}

/// A canvas of one pixel, for measuring texts.
struct Nowhere {
    cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, 1, 1);
    cairo_t* context = cairo_create(surface);
    Canvas canvas{context};

    Nowhere() = default;
    Nowhere(const Nowhere&) = delete;
    Nowhere& operator=(const Nowhere&) = delete;
    ~Nowhere() {
        cairo_destroy(context);
        cairo_surface_destroy(surface);
    }
};

TEST(PlotAxes, LabelsDoNotTouchOnAnyLength) {
    Nowhere nowhere;
    const std::vector<Axis> axes = {{"", 0, 1},
                                    {"", -1234.5, 99999},
                                    {"", 0.001234, 0.001239},
                                    {"", 1e-7, 1e5, true},
                                    {"", 20, 60, true},
                                    axis_of_words("", {"monodisperse", "weibull_wide", "weibull_narrow", "lognormal"}),
                                    axis_of_words("", std::vector<std::string>(40, "level"))};
    for (const auto& axis : axes)
        for (const double length : {40.0, 90.0, 200.0, 450.0})
            for (const bool upright : {false, true}) {
                const PlacedAxis placed{axis, 0, length};
                const auto found = labels_of(nowhere.canvas, placed, upright);
                ASSERT_FALSE(found.ticks.empty());
                double end = -std::numeric_limits<double>::infinity();
                for (const auto& tick : found.ticks) {
                    const bool lengthwise = !upright && !found.slanted;
                    const double half = (lengthwise ? nowhere.canvas.width(tick.label, label_size) : label_size) / 2;
                    const double at = placed.place(tick.at).value();
                    EXPECT_GT(at - half, end) << tick.label << " on " << length << (upright ? " upright" : "");
                    end = at + half;
                }
            }
}

TEST(PlotAxes, ALogarithmicAxisHasNoPlaceForZero) {
    const Axis axis{"", 0.1, 10, true};
    const PlacedAxis placed{axis, 0, 100};
    EXPECT_FALSE(placed.place(0));
    EXPECT_FALSE(placed.place(std::nan("")));
    EXPECT_NEAR(placed.place(1).value(), 50, 1e-9);
}

TEST(PlotCanvas, BreaksLinesAtSpacesOnly) {
    Nowhere nowhere;
    const auto lines = nowhere.canvas.wrapped("mean mass flow (kg/s)", 8, 50);
    EXPECT_GT(lines.size(), 1U);
    std::string joined;
    for (const auto& line : lines) joined += (joined.empty() ? "" : " ") + line;
    EXPECT_EQ(joined, "mean mass flow (kg/s)");
    EXPECT_LT(nowhere.canvas.width("m³", 8), nowhere.canvas.width("m3", 8)) << "raised digits are small";
}

Figure some_figure() {
    Panel panel{{"gap (mm)", 0, 5}, {"rate (g/s)", 0, 2}};
    panel.marks = {Band{{1, 2, 3}, {0.4, 0.5, 0.6}, {0.8, 0.9, 1.0}}, Line{{1, 2, 3}, {0.6, std::nan(""), 0.8}},
                   Points{{1, 2, 3}, {0.6, 0.7, 0.8}}, Whiskers{{1, 2}, {0.6, 0.7}, {0.1, std::nan("")}}, Marker{4}};
    Panel map{axis_of_words("law", {"sjkr", "dmt"}), {"gap (mm)", 0, 2}};
    map.marks = {Cells{{-0.5, 0.5, 1.5}, {0, 1, 2}, {along_scale(0), along_scale(1), std::nullopt, along_scale(0.5)}}};
    map.scale = Axis{"rate (g/s)", 0, 1};
    return {{panel, map}, {{"cases", blue}, {"failed cases", black, Key::Kind::cross}}};
}

TEST(PlotFiles, HaveTheWidthAndTheSameBytesAgain) {
    for (const double width : {85.0, 170.0}) {
        for (const auto type : {FileType::pdf, FileType::png, FileType::svg})
            EXPECT_TRUE(drawn(some_figure(), width, type) == drawn(some_figure(), width, type));
        const auto png = drawn(some_figure(), width, FileType::png);
        const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(png[k]); };
        const auto word = [&](std::size_t k) {
            return byte(k) << 24U | byte(k + 1) << 16U | byte(k + 2) << 8U | byte(k + 3);
        };
        EXPECT_EQ(word(16), std::lround(width / 25.4 * 600));
        EXPECT_EQ(png.substr(37, 4), "pHYs");
        EXPECT_EQ(word(41), 23'622U) << "600 points an inch, in points a metre";
    }
    EXPECT_NE(drawn(some_figure(), 85, FileType::svg).find("width=\"240.94pt\""), std::string::npos);
    EXPECT_NE(drawn(some_figure(), 85, FileType::pdf).find("/CreationDate (20000101000000Z)"), std::string::npos);
}

TEST(PlotSvg, HoldsTextsAsTextsAndNoIds) {
    auto figure = some_figure();
    figure.panels[0].x.title = "a < b & \"c\" (m³)";
    const auto svg = drawn(figure, 85, FileType::svg);
    EXPECT_THAT(svg, HasSubstr("a &lt; b &amp; \"c\" (m<tspan dy=\"-2.72\" font-size=\"5.76\">3</tspan>"
                               "<tspan dy=\"2.72\">)</tspan></text>"));
    for (const char* text : {"rate (g/s)", "failed cases", "sjkr", "(b)"}) EXPECT_THAT(svg, HasSubstr(text));
    EXPECT_THAT(svg, Not(HasSubstr(" id=")));
    EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(PlotSvg, HasEveryMarkAtItsPlace) {
    // Axes from 0 to 10 over a frame: numbers are places within it.
    Panel panel{{"", 0, 10}, {"", 0, 10}};
    panel.marks = {Points{{0, 10}, {0, 5}, {blue}, Points::Shape::dot, 1}, Line{{0, 5, 10}, {0, std::nan(""), 10}},
                   Line{{0, 10}, {10, 10}, vermilion, 1, true}, Bars{{2}, {4}, {5}, faded(blue, 0.5)}};
    const auto svg = drawn({{panel}}, 85, FileType::svg);
    static const std::regex frame(R"re(<svg x="[\d.]+" y="[\d.]+" width="([\d.]+)" height="([\d.]+)">)re");
    std::vector<std::pair<double, double>> clips;
    for (std::sregex_iterator found(svg.begin(), svg.end(), frame), end; found != end; ++found)
        clips.emplace_back(std::stod((*found)[1]), std::stod((*found)[2]));
    ASSERT_EQ(clips.size(), 4U) << "one for each mark";
    const auto [width, height] = clips[1];
    EXPECT_NEAR(clips[0].first, width + 5, 0.02) << "a sign at the edge is whole";
    EXPECT_THAT(svg, HasSubstr(fmt::format("<g fill=\"#0072b2\">\n<circle cx=\"2.5\" cy=\"{:.2f}\" r=\"1\"/>\n"
                                           "<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"1\"/>",
                                           height + 2.5, width + 2.5, height / 2 + 2.5)));
    EXPECT_THAT(svg, HasSubstr("stroke=\"#d55e00\" stroke-width=\"1\" stroke-dasharray=\"3 2\" d=\"M0 0H"));
    EXPECT_THAT(svg, HasSubstr("<path fill=\"#0072b2\" fill-opacity=\"0.5\" d=\"M"));
    EXPECT_THAT(svg, HasSubstr("stroke=\"#0072b2\" stroke-width=\"1\" d=\"M0 "));
    EXPECT_THAT(svg, Not(HasSubstr("\"L"))) << "the line is broken at NaN";
}

TEST(PlotFiles, TypeIsTheEndOfTheName) {
    EXPECT_EQ(file_type("a.pdf"), FileType::pdf);
    EXPECT_EQ(file_type("a.svg"), FileType::svg);
    EXPECT_EQ(file_type("b/a.png"), FileType::png);
    EXPECT_EQ(file_type("a.jpg"), std::nullopt);
}

}  // namespace grainsweep::tests::plot_figures_test
