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

/// One sphere that moves as the test says, followed at every move, and a probe that counts its passages.
struct Watched : Bed {
    std::unique_ptr<machine::Probe> probe;
    dem::Crossings crossings;
    bool followed = false;
    double last = 0;
    Watched(const char* name, const Options& options) : probe(machine::find_probe(name)->make(options)) {}
    double at(double x, double, double when, double z = 0) {
        const auto now = frame();
        state.position[0] = {x, 0, z};
        const auto place = [&](std::size_t) { return state.position[0]; };
        const auto mobile = [](std::size_t) { return true; };
        constexpr double everywhere = 10;
        if (!followed) {
            crossings = dem::Crossings(probe->planes(), domain);
            crossings.list(1, everywhere, mobile, place);
        }
        followed = true;
        crossings.follow(
            when, when - std::exchange(last, when), [](std::size_t) { return 0; }, place);
        std::vector<dem::Crossing> found;
        crossings.take(found);
        for (const auto& one : found)
            probe->passed(now, {static_cast<std::size_t>(one.id), one.plane, one.forward, one.steps, one.position});
        return probe->look(now);
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
    (void)copy.at(0, 1, 0.2);
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
}

TEST(MachineFlow, ResidenceTimesHaveADensity) {
    Bed bed;
    for (std::size_t k = 0; k < 3; ++k) bed.add({0.05, 0.1 * static_cast<double>(k), 0}, 0);
    Options options = residence();
    options.set("longest", 0.3), options.set("bins", 3.0);
    const auto density = machine::find_probe("residence_time_density")->make(options);
    const auto mean = machine::find_probe("residence_time")->make(residence());
    const auto deviation = machine::find_probe("residence_time_sd")->make(residence());
    const std::vector<double> times = {0.2, 0.2, 0.1};
    for (const std::size_t plane : {0U, 1U})
        for (std::size_t id = 0; id < 3; ++id)
            for (const auto* probe : {&density, &mean, &deviation})
                (*probe)->passed(bed.frame(), {id, plane, true, plane == 0 ? 0.05 : 0.05 + times[id], {0.1, 0, 0}});
    (void)density->look(bed.frame());
    EXPECT_NEAR(mean->look(bed.frame()), (0.2 + 0.2 + 0.1) / 3, 1e-12);
    EXPECT_NEAR(deviation->look(bed.frame()), 0.1 * std::sqrt(2.0) / 3, 1e-12);
    std::vector<Sample> bins;
    density->profile(bed.frame(), bins);
    ASSERT_EQ(bins.size(), 3U);
    EXPECT_NEAR(bins[0].value + bins[1].value + bins[2].value, 10, 1e-12) << "density times 0.1 s is 1";
    const auto flaw = machine::find_probe("residence_time")->flaw;
    EXPECT_NE(flaw(with("from", 0.3, "to", 0.1)), "");
}

}  // namespace grainsweep::tests::machine_flow_test
