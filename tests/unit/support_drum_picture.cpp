// The comparison of drum pictures that the GranuDrum check uses: areas, closings and differences known by hand.
#include "tests/support/drum_picture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

namespace grainsweep::tests::support_drum_picture_test {

double sum(const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0);
}

TEST(DrumPictureMap, EachIntervalPaintsOneUnitAndTheLastItsDiscToo) {
    const DrumPicture picture(1, 50);  // pixels of 0.04
    DrumFrames frames;
    frames.radius = {0.1};
    frames.centres = {{{-0.3, 0.11}}, {{0.013, 0.2}}, {{0.25, -0.4}}};
    // The polygon of a disc: both halves, 16 vertices each, 30 different ones of 32: area 15 r^2 sin(pi/15).
    const double last = std::hypot(0.25 - 0.013, 0.6), disc = 15 * 0.01 * std::sin(std::numbers::pi / 15);
    EXPECT_NEAR(sum(picture.map(frames)), 2 + disc / (0.2 * last), 1e-9);
    // Wide bars are even inside: 1/(2 r d) per area.
    DrumFrames wide{{{{-0.5, 0.0}}, {{0.5, 0.0}}}, {0.3}};
    const auto map = picture.map(wide);
    EXPECT_NEAR(map[25 * 50 + 25], 0.04 * 0.04 / (0.6 * 1), 1e-12);
    EXPECT_NEAR(map[25 * 50 + 2], 0, 1e-12);
    // What does not move is left out, what leaves the picture is cut.
    const DrumFrames still{{{{0.0, 0.0}}, {{0.0, 0.0}}}, {0.3}};
    EXPECT_EQ(sum(picture.map(still)), 0);
    const DrumFrames leaving{{{{0.0, 0.0}}, {{3.0, 0.0}}}, {0.1}};
    const DrumFrames entering{{{{-3.0, 0.0}}, {{0.0, 0.0}}}, {0.1}};
    // A length 1 of the bar, and half a disc at its end: behind the start, or ahead of the end.
    const double within = (0.2 * 1 + std::numbers::pi * 0.01 / 2) / (0.2 * 3);
    EXPECT_NEAR(sum(picture.map(leaving)), within, 1e-3);
    EXPECT_NEAR(sum(picture.map(entering)), within, 1e-3);
}

TEST(DrumPictureMap, CoverCountsFrames) {
    const DrumPicture picture(1, 100);
    const DrumFrames frames{{{{0.0, 0.0}}, {{0.5, 0.0}}}, {0.2}};
    const auto share = picture.cover(frames);
    EXPECT_NEAR(sum(share) * 4e-4, std::numbers::pi * 0.04, 2e-3);
    EXPECT_EQ(share[50 * 100 + 50], 0.5);
    const auto half = picture.of_cover(share, 0.5), more = picture.of_cover(share, 0.6);
    EXPECT_NEAR(picture.difference(half, more), 2 * std::numbers::pi * 0.04, 0.02) << "both discs lie in the mask";
    EXPECT_EQ(picture.difference(half, half), 0);
}

TEST(DrumPictureMap, ClosingFillsWhatIsNarrow) {
    const DrumPicture picture(1, 100);
    std::vector<double> share(picture.pixels(), 0);
    for (std::size_t j = 40; j < 60; ++j)
        for (std::size_t i = 40; i < 60; ++i)
            if (i < 48 || i > 51) share[j * 100 + i] = 1;  // a slit of four pixels
    const auto closed = picture.of_cover(share, 0.5);
    EXPECT_EQ(closed[50 * 100 + 49], 1);
    EXPECT_EQ(closed[50 * 100 + 39], 0) << "nothing grows outwards";
    EXPECT_EQ(closed[39 * 100 + 49], 0);
    EXPECT_EQ(picture.mask()[50 * 100 + 10], 0) << "0.79 of the radius";
    EXPECT_EQ(picture.mask()[50 * 100 + 13], 1);
}

}  // namespace grainsweep::tests::support_drum_picture_test
