// Probes of vessels that empty and of heaps, on spheres placed by hand.
#include "tests/support/machine_bed.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace grainsweep::tests::machine_vessels_test {

using namespace geometry;
using machine::Options;
using machine::Region;

constexpr Vec3 ex{1, 0, 0}, ez{0, 0, 1};

machine::OptionValue above() {
    return Region{Region::Half{{}, ez}};
}

TEST(MachineVessels, WhatHasLeftIsBelowOrGone) {
    Bed bed;
    bed.add({0, 0, 0.1}, 0), bed.add({0, 0, -0.1}, 1), bed.add({0.1, 0, 0.1}, 1), bed.add({0.2, 0, 0.1}, 0, {}, 0.003);
    const double a = 1000 * volume(0.002), b = 3000 * volume(0.004), c = 1000 * volume(0.003);
    EXPECT_EQ(bed.look("discharged_number", with("from", above())), 1);
    EXPECT_EQ(bed.look("discharged_number"), 0) << "all are in the domain";
    bed.lose(2);
    EXPECT_EQ(bed.look("discharged_number", with("from", above())), 2);
    EXPECT_EQ(bed.look("discharged_number"), 1);
    EXPECT_DOUBLE_EQ(bed.look("discharged_mass", with("from", above())), 2 * b);
    EXPECT_DOUBLE_EQ(bed.look("discharged_diameters", with("from", above())), 0.008);
    EXPECT_DOUBLE_EQ(bed.look("discharged_share", with("from", above())), 2 * b / (a + 2 * b + c));
    EXPECT_EQ(bed.look("discharged_mass", with("from", above(), "of", of({0}))), 0);
    EXPECT_EQ(bed.look("discharged_share", with("from", above(), "of", of({1}))), 1);
    bed.lose(2);
    EXPECT_DOUBLE_EQ(bed.look("discharged_diameters", with("from", above())), 0.011) << "a size of its own";
    EXPECT_DOUBLE_EQ(bed.look("discharged_share", with("from", above(), "of", of({0}))), c / (a + c));
    bed.lose(1), bed.lose(0);
    EXPECT_EQ(bed.look("discharged_share"), 1) << "exactly";
    Bed none;
    EXPECT_TRUE(std::isnan(none.look("discharged_share")));
    EXPECT_EQ(none.look("discharged_mass"), 0);
}

TEST(MachineVessels, GluedParticlesHaveNotLeft) {
    Bed bed;
    bed.add({0, 0, 0.1}, 0), bed.add({0, 0, -0.1}, 1), bed.add({0.1, 0, -0.1}, 0), bed.add({0.2, 0, 0.1}, 1);
    for (const std::size_t glued : {2, 3}) bed.setup.spheres[glued].mobile = false;
    const double a = 1000 * volume(0.002), b = 3000 * volume(0.004);
    EXPECT_EQ(bed.look("discharged_number", with("from", above())), 1);
    EXPECT_DOUBLE_EQ(bed.look("discharged_share", with("from", above())), b / (a + b));
}

// A lattice of spheres of 2 mm, one per cube of 3 mm, in a vessel of 15 x 15 mm, 60 mm high.
TEST(MachineVessels, ABedHasItsFractionClearOfItsEnds) {
    Bed bed, lying;
    for (int k = 0; k < 20; ++k)
        for (int i = 0; i < 25; ++i) {
            const double x = 0.003 * (i % 5), y = 0.003 * (i / 5), z = 0.003 * k + 0.0015;
            bed.add({x, y, 0.1 + z}, 0), lying.add({0.1 + z, x, y}, 0);
        }
    const Vec3 bottom{0, 0, 0.1};
    const auto options = with("from", bottom, "diameter", 0.0019, "section", 0.015 * 0.015);
    // From 5.7 mm to 5.7 mm below the 475th of 500 centres, which is at 55.5 mm: 15 layers within 44.1 mm.
    EXPECT_NEAR(bed.look("bed_fraction", options), 15 * 25 * volume(0.002) / (0.015 * 0.015 * 0.0441), 1e-12);
    const auto sideways = with("from", Vec3{0.1, 0, 0}, "along", ex, "diameter", 0.0019, "section", 0.015 * 0.015);
    EXPECT_NEAR(lying.look("bed_fraction", sideways), bed.look("bed_fraction", options), 1e-12);
    EXPECT_TRUE(std::isnan(bed.look("bed_fraction", with("from", bottom, "diameter", 0.01, "section", 1.0)))) << "low";
    EXPECT_TRUE(std::isnan(bed.look("bed_fraction", with("of", of({1}), "diameter", 0.002, "section", 1.0))));
}

// Four towers about a higher one: columns of 10 mm about the mass centre, which lies on the border of four columns.
TEST(MachineVessels, AHeapHasAnOutlineAndAnAngle) {
    const auto heap = [](const auto& place) {
        Bed bed;
        for (const double x : {-0.005, 0.005})
            for (const double y : {-0.005, 0.005}) bed.add(place(x, y, 0.038), 1);  // top at 40 mm
        for (const double x : {-0.015, 0.015})
            for (const double y : {-0.005, 0.005}) {
                bed.add(place(x, y, 0.018), 1), bed.add(place(y, x, 0.018), 1);  // top at 20 mm
            }
        return bed;
    };
    Bed bed = heap([](double x, double y, double z) { return Vec3{0.3 + x, y - 0.2, z}; });
    const auto options = with("cell", 0.01, "reach", 0.04);
    const auto outline = [&](Bed& of_it, const Options& given) {
        std::vector<Sample> samples;
        machine::find_probe("heap_outline")->make(given)->profile(of_it.frame(), samples);
        return samples;
    };
    const auto rings = outline(bed, options);
    ASSERT_EQ(rings.size(), 4U);
    EXPECT_DOUBLE_EQ(rings[1].bin, 0.015);
    // Ring k: columns whose centre is k to k + 1 cells from the axis: 4 within one, 8 within two.
    EXPECT_NEAR(rings[0].value, 0.04, 1e-12);
    EXPECT_NEAR(rings[1].value, 0.02, 1e-12);
    EXPECT_EQ(rings[2].value, 0);
    EXPECT_NEAR(bed.look("heap_height", options), 0.04, 1e-12);
    EXPECT_TRUE(std::isnan(bed.look("heap_angle", with("cell", 0.01, "reach", 0.04, "by", word("outline")))))
        << "one ring alone lies on the slope";
    EXPECT_TRUE(std::isnan(bed.look("heap_outline", options)));
    // By moments: mean height and distance of 4 at 38 mm and sqrt(50) mm and 8 at 18 mm and sqrt(250) mm.
    const double z = (4 * 38 + 8 * 18) / 12.0, r = (4 * std::sqrt(50.0) + 8 * std::sqrt(250.0)) / 12;
    EXPECT_NEAR(bed.look("heap_angle", options), std::atan(2 * z / r) * 180 / std::numbers::pi, 1e-9);
    // Nine tenths of 12: the eleventh.
    EXPECT_NEAR(bed.look("heap_run_out", options), std::sqrt(250e-6), 1e-12);
    // The same heap on a wall across x, 0.1 m from the origin.
    Bed turned = heap([](double x, double y, double up) { return Vec3{0.1 + up, x, y}; });
    const auto on_wall = with("cell", 0.01, "reach", 0.04, "along", ex, "from", Vec3{0.1, 0, 0});
    EXPECT_NEAR(turned.look("heap_angle", on_wall), bed.look("heap_angle", options), 1e-9);
    EXPECT_NEAR(turned.look("heap_height", on_wall), 0.04, 1e-12);
    const auto flaw = machine::find_probe("heap_angle")->flaw;
    EXPECT_EQ(flaw(options), "");
    EXPECT_NE(flaw(with("cell", 1e-6, "reach", 1.0)), "");
}

// A stair of one cell per ring has the slope of its steps.
TEST(MachineVessels, AStairHasTheAngleOfItsSteps) {
    Bed bed;
    for (int i = -6; i < 6; ++i)
        for (int j = -6; j < 6; ++j) {
            const double ring = std::floor(std::hypot(i + 0.5, j + 0.5));
            if (ring < 5) bed.add({0.01 * (i + 0.5), 0.01 * (j + 0.5), 0.005 * (5 - ring) - 0.001}, 0);
        }
    const auto outline = with("cell", 0.01, "reach", 0.06, "by", word("outline"));
    EXPECT_NEAR(bed.look("heap_angle", outline), std::atan(0.5) * 180 / std::numbers::pi, 1e-9);
    EXPECT_NEAR(bed.look("heap_residual", with("cell", 0.01, "reach", 0.06)), 0, 1e-12);
}

TEST(MachineVessels, WhatCannotMoveHasNoSpeedAndIsNoHeap) {
    Bed bed;
    bed.add({0, 0, 0.001}, 0, {3, 0, 0}), bed.add({0.01, 0, 0.002}, 1, {0, 4, 0});
    EXPECT_DOUBLE_EQ(bed.look("rms_speed"), std::sqrt(12.5)) << "by number";
    EXPECT_EQ(bed.look("rms_speed", with("of", of({0}))), 3);
    EXPECT_EQ(bed.look("rms_speed", with("in", box({1, 1, 1}, {2, 2, 2}))), 0);
    bed.state.mobile[1] = 0;
    EXPECT_EQ(bed.look("rms_speed"), 3);
    EXPECT_NEAR(bed.look("heap_height", with("cell", 0.01, "reach", 0.02)), 0.002 / 4, 1e-12) << "one column of four";
    bed.state.mobile[0] = 0;
    EXPECT_EQ(bed.look("rms_speed"), 0);
    EXPECT_TRUE(std::isnan(bed.look("heap_height", with("cell", 0.01, "reach", 0.02))));
}

}  // namespace grainsweep::tests::machine_vessels_test
