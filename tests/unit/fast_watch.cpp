// Checks of the mixed engine: energy that contacts create is reported with the particle, energy that walls or gravity
// give is not, also across a periodic face.
#include "solver/dem/fast/scale.hpp"
#include "solver/dem/fast/watch.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grainsweep::tests::fast_watch_test {

using namespace dem;
using namespace dem::fast;

/// Two spheres of 1 mm without contact, of which the second moves.
struct Two {
    Setup setup;
    ListSpace space;
    Record records[2]{};
    dem::fast::Field field{};
    std::int32_t id[2] = {0, 1};
    std::vector<Velocities> motions{2};

    explicit Two(bool periodic) : space{} {
        setup.domain = {{-0.01, -0.01, -0.01}, {0.01, 0.01, 0.01}, {false, false, periodic}};
        setup.gravity = {0, 0, -10};
        setup.time_step = 1e-5;
        setup.spheres = {{{0, 0, 0}, {}, {}, 5e-4, true}, {{0, 0, 3e-3}, {}, {}, 5e-4, true}};
        space.domain = setup.domain;
        space.scale = make_scale(setup);
        for (auto& r : records) r.inverse_mass = 1, r.radius = 0.5F;
        field.records = records;
        field.count = 2;
    }
    [[nodiscard]] double mass() const { return space.scale.mass; }
    [[nodiscard]] Moment now() const { return {field, space, id, motions, {}, 0}; }
    void fall(double distance) {
        for (auto& r : records)
            r.position[2] = static_cast<std::int32_t>(
                static_cast<std::uint32_t>(r.position[2]) -
                static_cast<std::uint32_t>(static_cast<std::int64_t>(std::nearbyint(distance / space.scale.unit[2]))));
    }
    void speed(double v) {
        for (auto& m : motions) m.velocity = {0, 0, v};
    }
};

TEST(FastWatch, FallingIsSoundAlsoThroughAPeriodicFace) {
    for (const bool periodic : {false, true}) {
        Two two(periodic);
        Watch watch(two.setup, two.space.scale);
        watch.set_limit(two.now(), {});
        std::int32_t particle = -1;
        EXPECT_EQ(watch.check(two.now(), particle), "");
        double fallen = 0;
        for (int k = 0; k < (periodic ? 20 : 3); ++k) {
            two.fall(2e-3);
            fallen += 2e-3;
            two.speed(-std::sqrt(2 * 10 * fallen));
            EXPECT_EQ(watch.check(two.now(), particle), "") << k;
        }
    }
}

TEST(FastWatch, EnergyFromNowhereIsReportedAndEnergyOfWallsIsNot) {
    Two two(false);
    Watch watch(two.setup, two.space.scale);
    two.speed(0.1);
    watch.set_limit(two.now(), {});
    std::int32_t particle = -1;
    EXPECT_EQ(watch.check(two.now(), particle), "");
    two.motions[1].velocity = {0.8, 0, 0};
    Watch pushed = watch;
    pushed.add_wall_work(0.5 * (0.8 * 0.8 - 0.1 * 0.1) / std::pow(two.space.scale.speed(), 2));
    EXPECT_EQ(pushed.check(two.now(), particle), "");
    const std::string what = watch.check(two.now(), particle);
    EXPECT_NE(what.find("contacts created"), std::string::npos) << what;
    EXPECT_EQ(particle, 1);
    watch.restart_balance();
    EXPECT_EQ(watch.check(two.now(), particle), "") << "a new balance begins";
}

TEST(FastWatch, LimitsTheSpeedByWhatTheCaseCanProduce) {
    Two two(false);
    Watch watch(two.setup, two.space.scale);
    two.speed(0.1);
    watch.set_limit(two.now(), {});
    // Ten times the start, the fall through 20 mm, and the energy of both in one.
    const double expected = 10 * (0.1 + std::sqrt(2 * 10 * 0.02) + std::sqrt(2 * 0.1 * 0.1));
    EXPECT_NEAR(watch.speed_limit(), expected, 1e-9);
    EXPECT_FALSE(watch.too_fast(0.5 * expected / two.space.scale.speed()));
    EXPECT_TRUE(watch.too_fast(1.01 * expected / two.space.scale.speed()));
    EXPECT_TRUE(watch.due(energy_interval_of_few));
    EXPECT_FALSE(watch.due(energy_interval_of_few + 1));
    Two around(true);
    Watch periodic(around.setup, around.space.scale);
    periodic.set_limit(around.now(), {});
    EXPECT_TRUE(std::isinf(periodic.speed_limit()));
    for (int k = 0; k < 30; ++k) periodic.add_travel(0.1);
    EXPECT_TRUE(periodic.due(1)) << "a quarter of a period of 20 diameters may have been covered";
}

}  // namespace grainsweep::tests::fast_watch_test
