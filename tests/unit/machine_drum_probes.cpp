// Probes of the bed in a turning drum, on a few spheres by hand: surface and flow, image, layer at the wall, rolling.
#include "solver/observables/turned_bed.hpp"
#include "tests/support/machine_bed.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <map>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

namespace grainsweep::tests::machine_drum_probes_test {

using namespace geometry;
using machine::Options;

constexpr Vec3 ex{1, 0, 0}, ey{0, 1, 0}, ez{0, 0, 1};
constexpr double drum_radius = 0.1, grain = 0.01;

/// Spheres of our own at every frame, seen by a probe that remembers.
struct Drum : Bed {
    std::unique_ptr<machine::Probe> probe;
    Drum(const char* name, const Options& options) : probe(machine::find_probe(name)->make(options)) {}
    void put(const Vec3& x, double radius, const Vec3& v = {}) {
        if (!engine) (void)frame();
        state.id.push_back(static_cast<std::int32_t>(state.id.size()));
        state.position.push_back(x), state.velocity.push_back(v), state.radius.push_back(radius);
        state.mobile.push_back(1), species.push_back(0), density.push_back(1000);
    }
    void clear() { state = {}, species.clear(), density.clear(); }
    double at(double when) {
        time = when;
        return probe->look(frame());
    }
    std::map<double, double> profile(double when) {
        time = when;
        std::vector<Sample> samples;
        probe->profile(frame(), samples);
        std::map<double, double> bins;
        for (const auto& sample : samples) bins[sample.bin] = sample.value;
        return bins;
    }
};

Options surface_options(const Vec3& axis = ey) {
    return with("axis", axis, "radius", drum_radius, "length", grain, "diameter", grain);
}

Options cover_options(double radius = drum_radius) {
    return with("axis", ey, "radius", radius, "cell", 0.01);
}

/// A sphere of D in a cell of D, D, D fills pi/6 of it; the fraction falls through 0.3 so far above its centre.
const double above_centre = grain * (1 - 0.3 / (std::numbers::pi / 6));

TEST(MachineDrum, TheSurfaceIsALineThroughTheMeanSolidFraction) {
    Drum slope("bed_surface_angle", surface_options());
    for (const double x : {-0.015, -0.005, 0.005, 0.015}) slope.put({x, 0.3, -x}, grain / 2);
    EXPECT_NEAR(slope.at(0), 45, 1e-9) << "raised towards negative x by a drum that turns about y";
    slope.clear();
    for (const double x : {-0.015, -0.005, 0.005, 0.015}) slope.put({x, 0.3, 0.005}, grain / 2);
    EXPECT_NEAR(slope.at(0), 45, 1e-9) << "a moment counts once";
    // Half of the fraction is below 0.3, except in the cell of both frames.
    EXPECT_TRUE(std::isnan(slope.at(1)));
    // Two of three frames are above: in cells over the centre, where the fraction falls to that of the cell above.
    const auto fall = [](double lower, double upper) { return grain * (lower - 0.3) / (lower - upper); };
    const double f = std::numbers::pi / 6, level = fall(2 * f / 3, 0);
    const double moment = -0.015 * (fall(2 * f / 3, f / 3) - level) - 0.005 * (fall(f, 0) - level);
    EXPECT_NEAR(slope.at(2), std::atan(-moment / 5e-4) * 180 / std::numbers::pi, 1e-9);

    Drum bent("bed_surface_residual", surface_options());
    for (const double x : {-0.015, 0.015}) bent.put({x, 0, 0.005}, grain / 2);
    for (const double x : {-0.005, 0.005}) bent.put({x, 0, -0.005}, grain / 2);
    EXPECT_NEAR(bent.at(0), 0.5, 1e-9) << "half of a cell above and below, over D";
    EXPECT_TRUE(std::isnan(Drum("bed_surface_residual", surface_options()).at(0)));
}

TEST(MachineDrum, TheAxisMayLieAnywhereAcrossGravity) {
    // Turning about x raises y > 0; the axis passes through (., 1, 2).
    auto options = surface_options(ex);
    options.set("through", Vec3{0, 1, 2});
    Drum drum("bed_surface_angle", options);
    for (const double y : {-0.015, -0.005, 0.005, 0.015}) drum.put({7, 1 + y, 2 + y}, grain / 2);
    EXPECT_NEAR(drum.at(1), 45, 1e-9);
    auto frame = drum.frame();
    frame.time = 2;
    frame.gravity = {1, 0, 0};
    EXPECT_NEAR(drum.probe->look(frame), 45, 1e-9) << "gravity along the axis: nothing is added";
    frame.gravity = {1, 0, -1};
    EXPECT_NEAR(drum.probe->look(frame), 45, 1e-9) << "the part across the axis counts";
    Drum upright("wall_layer_speed", with("axis", ez, "radius", drum_radius, "diameter", grain));
    upright.put({0.095, 0, 0}, grain / 2, ey);
    EXPECT_TRUE(std::isnan(upright.at(0)));
}

/// Two spheres whose surface is level, and tracers below it with a velocity in each half of a diameter.
void put_flow(Drum& drum) {
    for (const double x : {-0.035, 0.035}) drum.put({x, 0, -0.005}, grain / 2);
    const double height = -0.005 + above_centre;
    for (int k = 0; k < 12; ++k) {  // in the middles of cells of D/5
        const double z = -0.001 - 0.002 * k, depth = (height - z) / grain;
        const double speeds[] = {0.4, 0.3, 0.2, 0.1, -0.1};
        drum.put({0.001, 0, z}, 1e-6, {speeds[static_cast<int>(depth / 0.5)], 5, 0});
    }
    drum.put({0.09, 0, -0.001}, 1e-6, {99, 0, 0});  // far from the foot of the perpendicular
}

TEST(MachineDrum, TheFlowIsThatBelowTheLine) {
    Drum speed("bed_surface_speed", surface_options()), depth("bed_layer_depth", surface_options());
    put_flow(speed), put_flow(depth);
    EXPECT_NEAR(speed.at(0), (3 * 0.4 + 2 * 0.3) / 5, 1e-12) << "three and two tracers in the upper two halves";
    for (int frame = 0; frame < 10; ++frame) EXPECT_TRUE(std::isnan(depth.at(frame))) << "20 centres make no mean";
    // Between 0.1 in the middle of 1.5 to 2 D and -0.1 in that of 2 to 2.5 D.
    EXPECT_NEAR(depth.at(10), 2, 1e-9);
    for (int frame = 1; frame < 10; ++frame) EXPECT_NEAR(speed.at(frame), 0.36, 1e-12);
}

TEST(MachineDrum, TheCoverIsWhatParticlesHide) {
    Drum image("cover", cover_options());
    image.put({0.005, 0.4, -0.005}, 0.004);
    EXPECT_TRUE(std::isnan(image.at(0)));
    auto bins = image.profile(0);
    EXPECT_EQ(bins.size(), 316U) << "cells of 10 mm with centres in a circle of 100 mm";
    EXPECT_FALSE(bins.contains(0)) << "a corner";
    for (const auto& [bin, value] : bins) EXPECT_EQ(value, bin == 9 * 20 + 10 ? 1 : 0) << bin;
    image.clear();
    EXPECT_EQ(image.profile(1)[190], 0) << "of this frame alone";
    image.put({0.005, 0.4, -0.005}, 0.011);  // its neighbours, the diagonal ones not
    bins = image.profile(2);
    double hidden = 0;
    for (const auto& [bin, value] : bins) hidden += value;
    EXPECT_EQ(hidden, 5);

    Drum area("cover_area", cover_options());
    area.put({0.005, 0.4, -0.005}, 0.004);
    EXPECT_NEAR(area.at(0), 1e-4, 1e-12);
    area.clear(), area.put({0.025, 0.4, -0.005}, 0.004);
    EXPECT_NEAR(area.at(0), 1e-4, 1e-12) << "a moment counts once";
    EXPECT_NEAR(area.at(1), 2e-4, 1e-12) << "half of the frames each";
    EXPECT_NEAR(area.at(2), 1e-4, 1e-12);
}

TEST(MachineDrum, TheOutlineIsWhereTheMeanCoverFallsThroughHalf) {
    Drum outline("cover_outline", cover_options());
    outline.put({0.005, 0, -0.005}, 0.004), outline.put({-0.015, 0, 0.015}, 0.004);
    EXPECT_TRUE(std::isnan(outline.at(0)));
    auto bins = outline.profile(0);
    EXPECT_EQ(bins.size(), 20U) << "every column has a bin, so that frames can be compared";
    int found = 0;
    for (const auto& [x, z] : bins) {
        if (std::isnan(z)) continue;
        ++found;
        EXPECT_NEAR(z, x > 0 ? 0 : 0.02, 1e-12);
        EXPECT_NEAR(x, x > 0 ? 0.005 : -0.015, 1e-12);
    }
    EXPECT_EQ(found, 2);
    outline.clear();
    outline.put({0.005, 0, -0.005}, 0.004);
    bins = outline.profile(1);
    // Half of the frames hide the left cell: exactly at the level, so at its centre.
    EXPECT_NEAR(bins.lower_bound(-0.0151)->second, 0.015, 1e-12);

    const auto angle = [](double reach) {
        auto options = cover_options();
        options.set("reach", reach);
        Drum drum("cover_angle", options);
        for (const double x : {-0.015, -0.005, 0.005, 0.015}) drum.put({x, 0, -x}, 0.004);
        for (const double x : {-0.075, 0.075}) drum.put({x, 0, 0.005}, 0.004);
        return drum.at(0);
    };
    EXPECT_NEAR(angle(0.2), 45, 1e-9);
    EXPECT_LT(angle(1), 20) << "with the level ones outside";
    EXPECT_TRUE(std::isnan(angle(0.01))) << "no column is so near";
}

TEST(MachineDrum, TheLayerAtTheWallIsInItsLowerHalf) {
    Drum drum("wall_layer_speed", with("axis", ey, "radius", drum_radius, "diameter", grain));
    EXPECT_TRUE(std::isnan(drum.at(0)));
    // Turning about y carries the lowest point towards negative x.
    drum.put({0, 0, -0.0955}, grain / 2, {-3, 9, 9});
    drum.put({0, 0, -0.0935}, grain / 2, {50, 0, 0});  // 1.5 mm of 1 mm away
    drum.put({0, 0, 0.0955}, grain / 2, {50, 0, 0});
    EXPECT_NEAR(drum.at(1), 3, 1e-12);
    drum.put({0, 0.2, -0.095}, grain / 2, {-1, 0, 0});
    EXPECT_NEAR(drum.at(2), 2, 1e-12);
}

TEST(MachineDrum, RollingMomentsAreSummedByWall) {
    Bed bed;
    bed.add({}, 0), bed.add({0.01, 0, 0}, 0);
    (void)bed.frame();
    const auto touch = [&](std::int32_t first, std::int32_t second, const Vec3& moment) {
        dem::ContactForce contact;
        contact.first = first, contact.second = second, contact.rolling_moment = moment;
        bed.contacts.push_back(contact);
    };
    touch(0, 1, {0, 100, 0}), touch(0, -1, {1, 2, 3}), touch(1, -1, {0, 0.5, 0}), touch(1, -2, {0, 10, 0});
    touch(0, -3, {0, 1000, 0});
    EXPECT_EQ(bed.look("rolling_torque", with("wall", of({0}), "axis", ey)), 2.5);
    EXPECT_EQ(bed.look("rolling_torque", with("wall", of({0, 1}), "axis", ey)), 12.5);
    EXPECT_EQ(bed.look("rolling_torque", with("wall", of({0}), "axis", ez)), 3);
    EXPECT_EQ(bed.look("rolling_torque", with("wall", of({3}), "axis", ey)), 0) << "nothing touches it";
    EXPECT_TRUE(std::isnan(bed.look("rolling_torque", with("wall", of({}), "axis", ey))));
    EXPECT_TRUE(machine::find_probe("rolling_torque")->contacts);
}

TEST(MachineDrum, SumsAreRestoredAndOthersRefused) {
    for (const char* name : {"bed_surface_angle", "bed_surface_residual", "bed_surface_speed", "bed_layer_depth",
                             "cover_area", "cover_angle", "cover_outline"}) {
        SCOPED_TRACE(name);
        const bool surface = std::string(name).starts_with("bed");
        const auto options = surface ? surface_options() : cover_options();
        const auto look = [](Drum& drum, double when) { return std::pair{drum.at(when), drum.profile(when)}; };
        const auto same = [](const auto& a, const auto& b) {
            const auto equal = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
            bool all = equal(a.first, b.first) && a.second.size() == b.second.size();
            for (const auto& [bin, value] : a.second) all = all && equal(value, b.second.at(bin));
            return all;
        };
        Drum one(name, options), copy(name, options), fresh(name, options);
        put_flow(one);
        for (int frame = 0; frame < 11; ++frame) (void)look(one, frame);
        std::vector<std::byte> bytes;
        ByteWriter out(bytes);
        one.probe->save(out);
        ByteReader in(bytes);
        copy.probe->restore(in);
        in.finish();
        for (Drum* drum : {&one, &copy, &fresh}) {
            drum->clear();
            for (const double x : {-0.035, 0.035}) drum->put({x, 0, 0.055 - x}, 0.7 * grain);
        }
        EXPECT_TRUE(same(look(copy, 10), look(one, 10))) << "the frame of the last moment is there already";
        EXPECT_TRUE(same(look(copy, 11), look(one, 11)));
        EXPECT_FALSE(same(look(fresh, 12), look(one, 12)));

        auto larger = options;
        larger.set("radius", 2 * drum_radius);
        ByteReader again(bytes);
        EXPECT_THROW(machine::find_probe(name)->make(larger)->restore(again), std::invalid_argument);
        ByteReader cut(std::span<const std::byte>(bytes).first(bytes.size() - 1));
        EXPECT_THROW(machine::find_probe(name)->make(options)->restore(cut), std::invalid_argument);
    }
}

TEST(MachineDrum, TooManyCellsAreRefused) {
    EXPECT_EQ(machine::find_probe("cover")->flaw(cover_options()), "");
    EXPECT_EQ(machine::find_probe("cover_outline")->flaw(cover_options(5)), "");
    EXPECT_NE(machine::find_probe("cover_area")->flaw(cover_options(5.005)), "");
    auto fine = surface_options();
    EXPECT_EQ(machine::find_probe("bed_layer_depth")->flaw(fine), "");
    fine.set("diameter", 0.9e-4);
    EXPECT_NE(machine::find_probe("bed_layer_depth")->flaw(fine), "");
}

}  // namespace grainsweep::tests::machine_drum_probes_test
