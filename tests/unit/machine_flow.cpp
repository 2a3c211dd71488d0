// What passes through a plane: net crossings, particles that leave, periods, parts of the plane.
#include "tests/support/machine_bed.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

namespace grainsweep::tests::machine_flow_test {

using namespace geometry;
using machine::Options;

constexpr Vec3 ex{1, 0, 0};

/// One sphere that moves as the test says, seen by a probe that remembers.
struct Watched : Bed {
    std::unique_ptr<machine::Probe> probe;
    Watched(const char* name, const Options& options) : probe(machine::find_probe(name)->make(options)) {}
    double at(double x, double vx, double when, double z = 0) {
        (void)sight();
        state.position[0] = {x, 0, z};
        state.velocity[0] = {vx, 0, 0};
        time = when;
        return probe->look(sight());
    }
    double without(double when) {
        time = when;
        const dem::State none;
        return probe->look({*engine, none, contacts, species, density, domain, {0, 0, -9.81}, time});
    }
};

TEST(MachineFlow, CountsNetCrossingsOfAPlane) {
    const auto options = with("point", Vec3{0.1, 0, 0}, "normal", ex);
    Watched one("passed_number", options);
    one.add({}, 1);
    EXPECT_EQ(one.at(0, 1, 0), 0);
    EXPECT_EQ(one.at(0.09, 1, 0.1), 0);
    EXPECT_EQ(one.at(0.1, 1, 0.2), 1) << "by the centre, on the plane is beyond";
    EXPECT_EQ(one.at(0.2, 1, 0.3), 1);
    EXPECT_EQ(one.at(0.05, 1, 0.4), 0) << "back again";
    EXPECT_EQ(one.at(0.15, 1, 0.5), 1);
    Watched mass("passed_mass", with("point", Vec3{0.1, 0, 0}, "normal", Vec3{-1, 0, 0}));
    mass.add({}, 1);
    EXPECT_EQ(mass.at(0, 1, 0), 0);
    EXPECT_DOUBLE_EQ(mass.at(0.2, 1, 0.1), -3000 * volume(0.004)) << "against the normal";
    Watched other("passed_number", with("point", Vec3{0.1, 0, 0}, "normal", ex, "of", of({0})));
    other.add({}, 1);
    (void)other.at(0, 1, 0);
    EXPECT_EQ(other.at(0.2, 1, 0.1), 0) << "of another species";
    Watched part("passed_number",
                 with("point", Vec3{0.1, 0, 0}, "normal", ex, "in", box({0.05, -1, 0.01}, {0.5, 1, 0.02})));
    part.add({}, 1);
    (void)part.at(0, 1, 0);
    EXPECT_EQ(part.at(0.2, 1, 0.1), 0) << "beside the part of the plane";
    (void)part.at(0, 1, 0.2, 0.015);
    EXPECT_EQ(part.at(0.2, 1, 0.3, 0.015), 1);
}

TEST(MachineFlow, CountsParticlesThatLeave) {
    const auto options = with("point", Vec3{0.1, 0, 0}, "normal", ex);
    const auto left = [&](double x, double vx) {
        Watched one("passed_number", options);
        one.add({}, 1);
        (void)one.at(x, vx, 0);
        const double passed = one.without(0.1);
        EXPECT_EQ(one.without(0.2), passed) << "once";
        return passed;
    };
    EXPECT_EQ(left(0.05, 1), 1);
    EXPECT_EQ(left(0.05, -1), 0) << "it left elsewhere";
    EXPECT_EQ(left(0.05, 0.4), 0) << "it did not come so far";
    EXPECT_EQ(left(0.15, -1), -1);
    EXPECT_EQ(left(0.15, 1), 0) << "it had passed before it was seen";
    Watched falling("passed_number", with("point", Vec3{0, 0, -0.04}, "normal", Vec3{0, 0, -1}));
    falling.add({}, 0);
    (void)falling.at(0, 0, 0);
    EXPECT_EQ(falling.without(0.1), 1) << "g t^2/2 = 49 mm";
}

TEST(MachineFlow, AcrossAPeriodGoesOn) {
    Watched one("passed_number", with("point", Vec3{0.1, 0, 0}, "normal", ex));
    one.add({}, 1);
    one.domain = {{0, -1, -1}, {0.4, 1, 1}, {true, false, false}};
    (void)one.at(0.35, 1, 0);
    EXPECT_EQ(one.at(0.05, 1, 0.1), 0) << "through the face, not back through the plane";
    EXPECT_EQ(one.at(0.15, 1, 0.2), 1);
    EXPECT_EQ(one.at(0.3, 1, 0.3), 1);
    EXPECT_EQ(one.at(0.02, 1, 0.4), 1);
    EXPECT_EQ(one.at(0.15, 1, 0.5), 2);
    EXPECT_EQ(one.at(0.38, -1, 0.6), 1) << "backwards through plane and face";
}

TEST(MachineFlow, WhatAProbeRemembersIsRestored) {
    const auto options = with("point", Vec3{0.1, 0, 0}, "normal", ex);
    Watched one("passed_mass", options);
    one.add({}, 1);
    (void)one.at(0, 1, 0), (void)one.at(0.2, 1, 0.1), (void)one.at(0, 1, 0.2);
    std::vector<std::byte> bytes;
    ByteWriter out(bytes);
    one.probe->save(out);
    Watched copy("passed_mass", options);
    copy.add({}, 1);
    ByteReader in(bytes);
    copy.probe->restore(in);
    in.finish();
    EXPECT_EQ(copy.at(0.2, 1, 0.3), one.at(0.2, 1, 0.3));
    EXPECT_DOUBLE_EQ(copy.at(0.2, 1, 0.4), 3000 * volume(0.004));
}

/// A probe of residence times from x = 0.1 to 0.3.
Options residence() {
    return with("along", ex, "from", 0.1, "to", 0.3);
}

// At 2 m/s through 0.2 m: 0.1 s, whatever the frames are.
TEST(MachineFlow, ResidenceIsFromOnePlaneToTheOther) {
    for (const double interval : {0.003, 0.017, 0.04}) {
        Watched one("residence_time", residence());
        one.add({}, 1);
        double found = 0;
        for (double t = 0; t < 0.3; t += interval) found = one.at(2 * t, 2, t);
        EXPECT_NEAR(found, 0.1, 1e-12) << interval;
    }
}

TEST(MachineFlow, ResidenceCountsTheFirstPassagesOfWhatEntered) {
    Watched inside("residence_time", residence());
    inside.add({}, 1);
    (void)inside.at(0.2, 1, 0);
    EXPECT_TRUE(std::isnan(inside.at(0.4, 1, 0.2))) << "it did not enter";
    (void)inside.at(0.0, -1, 0.6), (void)inside.at(0.2, 1, 0.8);
    EXPECT_NEAR(inside.at(0.4, 1, 1.0), 0.2, 1e-12);
    (void)inside.at(0.0, -1, 1.4);
    EXPECT_NEAR(inside.at(0.4, 1, 2.4), 0.2, 1e-12) << "once";
    Watched back("residence_time", residence());
    back.add({}, 1);
    (void)back.at(0, 1, 0), (void)back.at(0.2, 1, 0.2), (void)back.at(0, -1, 0.4);
    EXPECT_NEAR(back.at(0.4, 1, 0.8), 0.6, 1e-12) << "since it first entered";
    // Gone while it flies at 1 m/s: from 0.25 it passes the second plane half-way through the next 0.1 s.
    Watched gone("residence_time", residence());
    gone.add({}, 1);
    (void)gone.at(0.05, 1, 0), (void)gone.at(0.25, 1, 0.2);
    EXPECT_NEAR(gone.without(0.3), 0.2, 1e-12);
}

TEST(MachineFlow, ResidenceTimesHaveADensity) {
    std::vector<double> speeds = {1, 1, 2};
    Bed bed;
    for (std::size_t k = 0; k < 3; ++k) bed.add({0.05, 0.1 * static_cast<double>(k), 0}, 0);
    Options options = residence();
    options.set("longest", 0.3), options.set("bins", 3.0);
    const auto density = machine::find_probe("residence_time_density")->make(options);
    const auto mean = machine::find_probe("residence_time")->make(residence());
    const auto deviation = machine::find_probe("residence_time_sd")->make(residence());
    double found[2] = {};
    (void)bed.sight();
    for (const double t : {0.0, 0.15, 0.3}) {
        bed.time = t;
        for (std::size_t k = 0; k < 3; ++k) bed.state.position[k][0] = 0.05 + speeds[k] * t;
        (void)density->look(bed.sight());
        found[0] = mean->look(bed.sight()), found[1] = deviation->look(bed.sight());
    }
    EXPECT_NEAR(found[0], (0.2 + 0.2 + 0.1) / 3, 1e-12);
    EXPECT_NEAR(found[1], 0.1 * std::sqrt(2.0) / 3, 1e-12);
    std::vector<Sample> bins;
    density->profile(bed.sight(), bins);
    ASSERT_EQ(bins.size(), 3U);
    EXPECT_NEAR(bins[0].value + bins[1].value + bins[2].value, 10, 1e-12) << "density times 0.1 s is 1";
    const auto flaw = machine::find_probe("residence_time")->flaw;
    EXPECT_NE(flaw(with("from", 0.3, "to", 0.1)), "");
}

}  // namespace grainsweep::tests::machine_flow_test
