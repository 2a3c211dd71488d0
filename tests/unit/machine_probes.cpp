// Every probe against a closed form, on states made by hand.
#include "stats/random.hpp"
#include "tests/support/machine_bed.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <vector>

namespace grainsweep::tests::machine_probes_test {

using namespace geometry;
using machine::Options;
using machine::Region;

constexpr double pi = std::numbers::pi;

constexpr Vec3 ex{1, 0, 0}, ey{0, 1, 0}, ez{0, 0, 1};

TEST(MachineProbes, AmountsAreSumsOverSpeciesAndRegion) {
    Bed bed;
    bed.add({0, 0, 0}, 0), bed.add({0.01, 0, 0}, 1), bed.add({0.02, 0, 0}, 1);
    EXPECT_EQ(bed.look("count"), 3);
    EXPECT_EQ(bed.look("count", with("of", of({1}))), 2);
    EXPECT_EQ(bed.look("count", with("in", box({-1, -1, -1}, {0.01, 1, 1}))), 2) << "by centres, the border included";
    EXPECT_EQ(bed.look("count", with("of", of({1}), "in", box({-1, -1, -1}, {0.015, 1, 1}))), 1);
    EXPECT_DOUBLE_EQ(bed.look("volume"), volume(0.002) + 2 * volume(0.004));
    EXPECT_DOUBLE_EQ(bed.look("mean_diameter"), (0.002 + 2 * 0.004) / 3);
    EXPECT_TRUE(std::isnan(bed.look("mean_diameter", with("in", box({1, 1, 1}, {2, 2, 2})))));
    EXPECT_DOUBLE_EQ(bed.look("mass"), 1000 * volume(0.002) + 6000 * volume(0.004));
    EXPECT_DOUBLE_EQ(bed.look("mass_share", with("of", of({0}))), volume(0.002) / (volume(0.002) + 6 * volume(0.004)));
    EXPECT_EQ(bed.look("mass_share", with("of", of({0}), "in", box({0.005, -1, -1}, {1, 1, 1}))), 0);
    EXPECT_TRUE(std::isnan(bed.look("mass_share", with("of", of({0}), "in", box({0.5, -1, -1}, {1, 1, 1})))));
    EXPECT_DOUBLE_EQ(bed.look("solid_fraction", with("in", box({-0.005, -0.005, -0.005}, {0.015, 0.005, 0.005}))),
                     (volume(0.002) + volume(0.004)) / (0.02 * 0.01 * 0.01));
    EXPECT_DOUBLE_EQ(bed.look("solid_fraction", with("in", Region{Region::Ball{{}, 0.005}})),
                     volume(0.002) / volume(0.01));
    const auto flaw = machine::find_probe("solid_fraction")->flaw;
    EXPECT_NE(flaw(with("in", Region{Region::Half{}})), "");
}

TEST(MachineProbes, GluedParticlesCountForNothing) {
    Bed bed, glued;
    for (Bed* one : {&bed, &glued})
        for (int k = 0; k < 40; ++k) one->add({0.003 * (k % 10), 0.004 * (k / 10), 0}, k % 3 == 0 ? 0 : 1);
    for (int k = 0; k < 5; ++k) {
        glued.add({0.003 * k, 0, 0.01}, 0);
        glued.setup.spheres.back().mobile = false;
    }
    const auto lacey = with("of", of({0, 1}), "cell", 0.012, "least", 0.0);
    EXPECT_EQ(glued.look("mass_share", with("of", of({0}))), bed.look("mass_share", with("of", of({0}))));
    EXPECT_FALSE(std::isnan(bed.look("lacey", lacey)));
    EXPECT_EQ(glued.look("lacey", lacey), bed.look("lacey", lacey));
    EXPECT_EQ(glued.look("radius", with("axis", ex, "about", word("bed"))),
              bed.look("radius", with("axis", ex, "about", word("bed"))));
}

TEST(MachineProbes, TheShareOfASizeCountsParticlesWhereTheyWereLastSeen) {
    Bed bed;
    for (int k = 0; k < 3; ++k) bed.add({0, 0, -0.01}, 0);
    bed.add({0.5, 0, 0}, 0), bed.add({0, 0, 0.1}, 0), bed.add({0.5, 0, 0}, 1);
    const auto curve = [&](machine::Options options) {
        options.set("in", box({-1, -1, -1}, {0.4, 1, 0})), options.set("from", 0.001), options.set("to", 0.007);
        options.set("bins", 3.0);
        const auto probe = machine::find_probe("size_share")->make(options);
        std::vector<Sample> samples;
        probe->profile(bed.frame(), samples);
        Bed empty;
        empty.add({0, 0, 0.1}, 1);
        samples.clear();
        probe->profile(empty.frame(), samples);  // its particle takes the place of the first one
        std::vector<double> shares;
        for (const auto& one : samples) shares.push_back(one.value);
        return shares;
    };
    const auto of_two = curve(with("beside", box({0.4, -1, -1}, {1, 1, 1})));
    EXPECT_DOUBLE_EQ(of_two[0], 2. / 3) << "the one above is in neither";
    EXPECT_EQ(of_two[1], 0);
    EXPECT_TRUE(std::isnan(of_two[2]));
    EXPECT_DOUBLE_EQ(curve({})[0], 2. / 4);
}

TEST(MachineProbes, VelocitiesAreWeightedByMass) {
    Bed bed;
    bed.add({0, 0, 0}, 0, {1, 0, 2}), bed.add({0.01, 0, 0}, 1, {-1, 3, 0});
    const double a = 1000 * volume(0.002), b = 3000 * volume(0.004);
    EXPECT_DOUBLE_EQ(bed.look("velocity", with("along", ex)), (a - b) / (a + b));
    EXPECT_DOUBLE_EQ(bed.look("velocity", with("along", ey, "of", of({1}))), 3);
    EXPECT_DOUBLE_EQ(bed.look("momentum", with("along", ez)), 2 * a);
    EXPECT_DOUBLE_EQ(bed.look("kinetic_energy"), a * 5 / 2 + b * 10 / 2);
    // T = reduced mass (v1 - v2)^2/(3 M): the difference is (2, -3, 2).
    EXPECT_NEAR(bed.look("granular_temperature"), a * b / (a + b) * 17 / (3 * (a + b)), 1e-15);
    EXPECT_TRUE(std::isnan(bed.look("velocity", with("along", ex, "in", box({1, 1, 1}, {2, 2, 2})))));
    EXPECT_EQ(bed.look("momentum", with("along", ex, "in", box({1, 1, 1}, {2, 2, 2}))), 0);
    EXPECT_TRUE(std::isnan(bed.look("granular_temperature", with("in", box({1, 1, 1}, {2, 2, 2})))));
}

TEST(MachineProbes, SpinIsTheMeanAngularVelocity) {
    Bed bed;
    bed.add({0, 0, 0}, 0), bed.add({0.01, 0, 0}, 1);
    (void)bed.frame();
    bed.state.angular_velocity = {{0, 5, 0}, {0, -2, 7}};
    const double a = 1000 * volume(0.002), b = 3000 * volume(0.004);
    EXPECT_DOUBLE_EQ(bed.look("spin", with("along", ey)), (5 * a - 2 * b) / (a + b));
    EXPECT_DOUBLE_EQ(bed.look("spin", with("along", ez, "of", of({1}))), 7);
}

TEST(MachineProbes, AStreamThatMovesAsOneIsCold) {
    Bed bed;
    for (int k = 0; k < 20; ++k) bed.add({0.01 * k, 0, 0}, static_cast<std::uint8_t>(k % 2), {1e3, 0.1, -7});
    EXPECT_GE(bed.look("granular_temperature"), 0);
    EXPECT_LT(bed.look("granular_temperature"), 1e-20);
}

TEST(MachineProbes, PlacesAreWeightedByVolume) {
    Bed bed;
    bed.add({0.003, 0.004, 0.01}, 0), bed.add({-0.006, 0.008, 0.02}, 1);
    const double a = volume(0.002), b = volume(0.004);
    EXPECT_DOUBLE_EQ(bed.look("centre", with("along", ez)), (a * 0.01 + b * 0.02) / (a + b));
    EXPECT_DOUBLE_EQ(bed.look("centre", with("along", ez, "from", Vec3{0, 0, 0.02}, "of", of({0}))), -0.01);
    EXPECT_DOUBLE_EQ(bed.look("radius", with("axis", ez)), (a * 0.005 + b * 0.01) / (a + b));
    EXPECT_DOUBLE_EQ(bed.look("radius", with("axis", ez, "through", Vec3{0.003, 0.004, 7}, "of", of({0}))), 0);
    // About the centre of the bed: the distances of two bodies are in the ratio of the other's volume.
    const double apart = std::hypot(0.009, 0.004);
    EXPECT_NEAR(bed.look("radius", with("axis", ez, "about", word("bed"), "of", of({0}))), apart * b / (a + b), 1e-15);
    EXPECT_NEAR(bed.look("radius", with("axis", ez, "about", word("bed"))), 2 * apart * a * b / (a + b) / (a + b),
                1e-15);
    EXPECT_DOUBLE_EQ(bed.look("mean_height"), (a * 0.01 + b * 0.02) / (a + b));
    EXPECT_DOUBLE_EQ(bed.look("mean_height", with("along", ex, "of", of({0}))), 0.003);
    EXPECT_TRUE(std::isnan(bed.look("centre", with("along", ez, "in", box({1, 1, 1}, {2, 2, 2})))));
    EXPECT_TRUE(std::isnan(bed.look("radius", with("axis", ez, "in", box({1, 1, 1}, {2, 2, 2})))));
}

// Raised by right hand about +x, a bed leans to +y: tan of the angle is y over depth below the axis.
TEST(MachineProbes, TheAngleOfABedIsThatOfItsCentre) {
    for (const double degrees : {-60.0, -1.0, 0.0, 35.0, 89.0}) {
        Bed bed;
        const double t = degrees * pi / 180;
        bed.add({0.1, 0.02 + 0.05 * std::sin(t), -0.05 * std::cos(t)}, 0);
        const auto options = with("axis", ex, "through", Vec3{0, 0.02, 0});
        EXPECT_NEAR(bed.look("bed_angle", options), degrees, 1e-10);
        EXPECT_NEAR(bed.look("bed_angle", with("axis", Vec3{-1, 0, 0}, "through", Vec3{0, 0.02, 0})), -degrees, 1e-10);
        EXPECT_TRUE(std::isnan(bed.look("bed_angle", with("axis", ez)))) << "an upright axis has no below";
    }
}

TEST(MachineProbes, HeightsHaveAShareOfTheVolumeBelow) {
    Bed bed;
    for (int k = 0; k < 10; ++k) bed.add({0.01 * k, 0, 0.01 * k}, 0);
    EXPECT_DOUBLE_EQ(bed.look("height", with("share", 0.49, "of_sphere", word("centre"))), 0.04);
    EXPECT_DOUBLE_EQ(bed.look("height", with("share", 0.55, "of_sphere", word("centre"))), 0.05);
    EXPECT_DOUBLE_EQ(bed.look("height", with("share", 0.01, "from", Vec3{0, 0, -1})), 1.001) << "the sphere's top";
    EXPECT_DOUBLE_EQ(bed.look("height"), 0.091) << "0.95";
    EXPECT_DOUBLE_EQ(bed.look("height", with("along", ex, "share", 0.25, "of_sphere", word("centre"))), 0.02);
    EXPECT_TRUE(std::isnan(bed.look("height", with("of", of({1})))));
    // The whole share, whatever the order of the sums.
    for (std::uint64_t seed = 0; seed < 50; ++seed) {
        Bed many;
        const stats::Stream chance(7, seed);
        double top = 0;
        for (std::uint64_t k = 0; k < 30; ++k) {
            const double z = chance.uniform(2 * k), d = 0.001 + 0.001 * chance.uniform(2 * k + 1);
            many.add({0.01 * static_cast<double>(k), 0, z}, 0, {}, d);
            top = std::max(top, z + d / 2);
        }
        EXPECT_DOUBLE_EQ(many.look("height", with("share", 1.0, "of_sphere", word("centre"))),
                         many.look("height", with("share", 1 - 1e-9, "of_sphere", word("centre"))));
        EXPECT_LE(many.look("height", with("share", 1.0)), top);
    }
}

// Cells of 10 mm on a chessboard of one species per cell: apart. Species alternating within every cell: s = 0, so that
// M = s0^2/(s0^2 - sr^2), slightly above 1.
TEST(MachineProbes, LaceyIsZeroApartAndAboveOneInPerfectOrder) {
    Bed apart, ordered;
    for (int i = 0; i < 8; ++i)
        for (int j = 0; j < 8; ++j)
            for (int k = 0; k < 8; ++k) {
                const Vec3 x{0.005 * i + 0.0025, 0.005 * j + 0.0025, 0.005 * k + 0.0025};
                apart.add(x, static_cast<std::uint8_t>(i < 4 ? 0 : 1), {}, 0.004);
                ordered.add(x, static_cast<std::uint8_t>((i + j + k) % 2), {}, 0.004);
            }
    const auto options = with("of", of({0, 1}), "cell", 0.01);
    const double v = volume(0.004);
    EXPECT_NEAR(apart.look("lacey", options), 0, 1e-12);
    // Equal spheres, P = 1/2, 8 of them in a cell: sr^2 = P (1 - P) v/(8 v).
    EXPECT_NEAR(ordered.look("lacey", options), 1 / (1 - 1.0 / 8), 1e-12);
    EXPECT_NEAR(ordered.look("lacey", with("of", of({1, 0}), "cell", 0.01)), 1 / (1 - 1.0 / 8), 1e-12) << "symmetric";
    // Shifted by half a cell, the seam is inside of cells.
    EXPECT_GT(apart.look("lacey", with("of", of({0, 1}), "cell", 0.01, "origin", Vec3{0.005, 0, 0})), 0.1);
    // A full cell is filled to 8 v/(1e-6 m3) = 0.268.
    EXPECT_FALSE(std::isnan(apart.look("lacey", with("of", of({0, 1}), "cell", 0.01, "least", 0.26))));
    EXPECT_TRUE(std::isnan(apart.look("lacey", with("of", of({0, 1}), "cell", 0.01, "least", 0.27))));
    EXPECT_NEAR(8 * v / 1e-6, 0.268, 1e-3);
    EXPECT_TRUE(std::isnan(ordered.look("lacey", with("of", of({0, 1}), "cell", 1.0, "least", 0.0)))) << "one cell";
    EXPECT_TRUE(std::isnan(ordered.look("lacey", with("of", of({0, 1}), "cell", 0.005, "least", 0.0))))
        << "one grain a cell";
    EXPECT_TRUE(
        std::isnan(apart.look("lacey", with("of", of({0, 1}), "cell", 0.01, "in", box({0, 0, 0}, {0.02, 1, 1})))))
        << "one species alone";
    EXPECT_NE(machine::find_probe("lacey")->flaw(with("of", of({0}))), "");
}

// By hand, two cells of 10 mm with unequal spheres: cell 1 has two a (v) and one b (8 v), cell 2 one a and two b.
TEST(MachineProbes, LaceyIsTheStatedFormula) {
    Bed bed;
    bed.add({0.002, 0.002, 0.002}, 0), bed.add({0.007, 0.002, 0.002}, 0), bed.add({0.005, 0.005, 0.006}, 1);
    bed.add({0.012, 0.002, 0.002}, 0), bed.add({0.016, 0.002, 0.002}, 1), bed.add({0.016, 0.007, 0.007}, 1);
    const double v = volume(0.002), p = 3.0 / 27;
    const double v1 = 10, v2 = 17, p1 = 0.2, p2 = 1.0 / 17;  // in v
    const double s2 = (v1 * (p1 - p) * (p1 - p) + v2 * (p2 - p) * (p2 - p)) / (v1 + v2);
    const double s0 = p * (1 - p), sr = s0 * (p * 8 + (1 - p) * 1) / ((v1 + v2) / 2);
    EXPECT_NEAR(bed.look("lacey", with("of", of({0, 1}), "cell", 0.01, "least", 0.0)), (s0 - s2) / (s0 - sr), 1e-12);
    EXPECT_GT(v, 0);
}

// Species drawn by chance for every place: 1 within five standard errors of the mean over 40 draws.
TEST(MachineProbes, LaceyOfAMixtureByChanceIsOne) {
    double sum = 0, squares = 0;
    constexpr int draws = 40;
    for (int n = 0; n < draws; ++n) {
        Bed bed;
        for (std::uint64_t k = 0; k < 1000; ++k) {
            const bool second = stats::Stream(11, static_cast<std::uint64_t>(n)).uniform(k) < 0.3;
            bed.add({0.005 * static_cast<double>(k % 10) + 0.0025, 0.005 * static_cast<double>(k / 10 % 10) + 0.0025,
                     0.005 * static_cast<double>(k / 100) + 0.0025},
                    second ? 1 : 0, {}, second ? 0.004 : 0.0035);
        }
        const double index = bed.look("lacey", with("of", of({0, 1}), "cell", 0.01, "least", 0.0));
        sum += index / draws, squares += index * index / draws;
    }
    const double error = std::sqrt((squares - sum * sum) / (draws - 1));
    EXPECT_NEAR(sum, 1, 5 * error + 1e-3);
    EXPECT_LT(error, 0.01);
}

TEST(MachineProbes, AWallCarriesTheWeightOfARestingSphere) {
    Bed bed;
    bed.add({0.03, 0.02, 0.002}, 1);
    bed.setup.walls.emplace_back(Plane{{0, 0, 0}, {0, 0, 1}});
    bed.setup.material.density = 3000;
    bed.setup.material.restitution = 0.1;
    bed.setup.time_step = 1e-6;
    (void)bed.frame();
    bed.engine->run(60000);
    bed.engine->state(bed.state);
    bed.engine->contacts(bed.contacts);
    const double weight = 3000 * volume(0.004) * 9.81;
    const auto wall = of({0});
    EXPECT_NEAR(bed.look("wall_force", with("wall", wall, "along", ez)), -weight, 1e-6 * weight);
    EXPECT_NEAR(bed.look("wall_pressure", with("wall", wall, "along", ez, "area", 0.01)), -weight / 0.01,
                1e-6 * weight / 0.01);
    EXPECT_NEAR(bed.look("wall_force", with("wall", wall, "along", ex)), 0, 1e-9 * weight);
    // Torque about y of a force -W z at x = 30 mm: x cross F = (0.03, 0.02, 0) x (0, 0, -W) = (-0.02 W, 0.03 W, 0).
    EXPECT_NEAR(bed.look("wall_torque", with("wall", wall, "axis", ey)), 0.03 * weight, 1e-6 * weight);
    EXPECT_NEAR(bed.look("wall_torque", with("wall", wall, "axis", ex)), -0.02 * weight, 1e-6 * weight);
    EXPECT_NEAR(bed.look("wall_torque", with("wall", wall, "axis", ey, "about", Vec3{0.03, 0.02, 0})), 0,
                1e-6 * weight);
    EXPECT_NEAR(bed.look("wall_work", with("wall", wall)), 0, 1e-12) << "a wall at rest does none";
    EXPECT_TRUE(std::isnan(bed.look("wall_force", with("wall", of({}), "along", ez)))) << "no wall at all";
    EXPECT_EQ(bed.look("coordination"), 0) << "a wall is no partner";
}

TEST(MachineProbes, CoordinationCountsPartners) {
    Bed bed;  // a row of three that touch, and one apart
    for (int k = 0; k < 3; ++k) bed.add({0.00399 * k, 0, 0}, 1);
    bed.add({0.1, 0, 0}, 0);
    EXPECT_EQ(bed.look("coordination"), 1);
    EXPECT_DOUBLE_EQ(bed.look("coordination", with("of", of({1}))), 4.0 / 3);
    EXPECT_EQ(bed.look("coordination", with("in", box({0.003, -1, -1}, {0.005, 1, 1}))), 2) << "the middle one";
    EXPECT_TRUE(std::isnan(bed.look("coordination", with("in", box({1, 1, 1}, {2, 2, 2})))));
    EXPECT_TRUE(machine::find_probe("coordination")->contacts);
    bed.engine->run(1);
    EXPECT_NEAR(bed.look("overlap"), 0.00001 / 0.004, 2e-2 * 0.0025);
}

TEST(MachineProbes, ProfilesAreBinsAlongADirection) {
    Bed bed;
    bed.add({0.005, 0, 0}, 0, {1, 2, 0}), bed.add({0.006, 0, 0}, 1, {3, 0, 0}), bed.add({0.025, 0, 0}, 1, {5, 0, 0});
    bed.add({0.05, 0, 0}, 0), bed.add({-0.01, 0, 0}, 0);  // outside of the bins
    const auto profile = [&](const Options& more) {
        Options options = more;
        options.set("along", ex), options.set("from", 0.0), options.set("to", 0.03), options.set("bins", 3.0);
        const auto probe = machine::find_probe("profile")->make(options);
        EXPECT_TRUE(std::isnan(probe->look(bed.frame())));
        std::vector<Sample> samples;
        probe->profile(bed.frame(), samples);
        EXPECT_EQ(samples.size(), 3U);
        EXPECT_DOUBLE_EQ(samples[1].bin, 0.015);
        return samples;
    };
    const double a = volume(0.002), b = volume(0.004);
    auto solid = profile({});
    EXPECT_DOUBLE_EQ(solid[0].value, a + b);
    EXPECT_EQ(solid[1].value, 0);
    EXPECT_DOUBLE_EQ(solid[2].value, b);
    EXPECT_DOUBLE_EQ(profile(with("of", of({0})))[0].value, a);
    auto velocity = profile(with("quantity", word("velocity")));
    EXPECT_DOUBLE_EQ(velocity[0].value, (a * 1 + b * 3) / (a + b));
    EXPECT_TRUE(std::isnan(velocity[1].value));
    EXPECT_DOUBLE_EQ(profile(with("quantity", word("velocity"), "velocity_along", ey, "of", of({0})))[0].value, 2);
    auto share = profile(with("quantity", word("share"), "of", of({0})));
    EXPECT_DOUBLE_EQ(share[0].value, a / (a + b));
    EXPECT_EQ(share[2].value, 0);
    const auto flaw = machine::find_probe("profile")->flaw;
    EXPECT_NE(flaw(with("from", 1.0, "to", 0.0)), "");
    EXPECT_NE(flaw(with("from", 0.0, "to", 1.0, "bins", 2.5)), "");
}

TEST(MachineProbes, AreSortedByNameAndFound) {
    std::set<std::string_view> names;
    for (const auto& probe : machine::probe_catalogue()) {
        EXPECT_TRUE(names.empty() || *names.rbegin() < probe.name) << probe.name;
        names.insert(probe.name);
        EXPECT_EQ(machine::find_probe(probe.name), &probe);
        EXPECT_NE(probe.unit, "") << probe.name;
        EXPECT_NE(probe.meaning, "") << probe.name;
    }
    EXPECT_EQ(machine::find_probe("temper"), nullptr);
}

}  // namespace grainsweep::tests::machine_probes_test
