// Regions of a machine: the depth of a point is at most its distance to the surface, bounds and volumes are right, and
// wrong numbers have a sentence.
#include "solver/machine/region.hpp"
#include "stats/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace grainsweep::tests::machine_regions_test {

using namespace geometry;
using machine::Bounds;
using machine::Region;

constexpr double infinity = std::numeric_limits<double>::infinity();

Region box() {
    return {Region::Box{{-1, -2, 0}, {1, 2, 3}}};
}
Region hollow() {
    return {Region::Round{.base = {0, 0, -1}, .axis = {0, 0, 1}, .radius = 2, .inner = 0.5, .length = 4}};
}
Region tilted() {
    const double s = std::numbers::sqrt2 / 2;
    return {Region::Round{.base = {1, 0, 0}, .axis = {s, 0, s}, .radius = 1.5, .inner = 0, .length = 2}};
}
Region ball() {
    return {Region::Ball{{0.5, 0, 1}, 1.5}};
}
Region above() {
    return {Region::Half{{0, 0, 1}, {0, 0, 1}}};
}
std::vector<Region> all_kinds() {
    return {box(),
            hollow(),
            tilted(),
            ball(),
            above(),
            {Region::All{{box(), ball(), above()}}},
            {Region::Any{{ball(), tilted()}}},
            {Region::Not{{hollow()}}},
            {Region::All{{box(), {Region::Not{{ball()}}}}}}};
}

Vec3 random_point(std::uint64_t n, double reach) {
    Vec3 x{};
    for (std::size_t k = 0; k < 3; ++k) x[k] = reach * (2 * stats::Stream(3, n).uniform(k) - 1);
    return x;
}

TEST(MachineRegions, DepthOfPointsIsTheDistanceToTheSurface) {
    EXPECT_DOUBLE_EQ(box().depth({0, 0, 1}), 1);
    EXPECT_DOUBLE_EQ(box().depth({0.9, 1.5, 1}), 0.1);
    EXPECT_DOUBLE_EQ(box().depth({0, 0, 3.5}), -0.5);
    EXPECT_DOUBLE_EQ(hollow().depth({1.2, 0, 1}), 0.7);
    EXPECT_DOUBLE_EQ(hollow().depth({0, 1.9, 1}), 2 - 1.9);
    EXPECT_DOUBLE_EQ(hollow().depth({0, 0, 1}), -0.5) << "in the hollow";
    EXPECT_DOUBLE_EQ(hollow().depth({1.2, 0, 2.75}), 0.25) << "below its end";
    EXPECT_NEAR(tilted().depth({1, 0, 0}), 0, 1e-15) << "the middle of its first end";
    EXPECT_NEAR(tilted().depth({1 + std::numbers::sqrt2 / 2, 0, std::numbers::sqrt2 / 2}), 1, 1e-15);
    EXPECT_DOUBLE_EQ(ball().depth({0.5, 0, 1}), 1.5);
    EXPECT_DOUBLE_EQ(ball().depth({0.5, 3, 1}), -1.5);
    EXPECT_DOUBLE_EQ(above().depth({7, 8, 3}), 2);
    EXPECT_DOUBLE_EQ((Region{Region::Not{{above()}}}.depth({7, 8, 3})), -2);
    EXPECT_DOUBLE_EQ((Region{Region::All{{box(), above()}}}.depth({0, 0, 1.25})), 0.25);
    EXPECT_DOUBLE_EQ((Region{Region::Any{{box(), above()}}}.depth({0, 0, 10})), 9);
}

// A sphere of that radius around the point lies on one side of the surface: so a filling is wholly inside.
TEST(MachineRegions, DepthNeverExceedsTheDistance) {
    for (const Region& region : all_kinds())
        for (std::uint64_t n = 0; n < 400; ++n) {
            const Vec3 x = random_point(n, 4);
            const double depth = region.depth(x);
            for (std::uint64_t m = 0; m < 20; ++m) {
                Vec3 step = random_point(1000 * n + m, 1);
                const double length = norm(step);
                if (length == 0) continue;
                step = (std::abs(depth) * (1 - 1e-9) / length) * step;
                ASSERT_EQ(region.contains(x + step), depth >= 0) << region.is.index() << " " << n;
            }
        }
}

TEST(MachineRegions, BoundsHoldEveryPointAndAreTight) {
    for (const Region& region : all_kinds()) {
        const Bounds bounds = region.bounds();
        for (std::uint64_t n = 0; n < 3000; ++n) {
            const Vec3 x = random_point(n, 5);
            if (!region.contains(x)) continue;
            for (std::size_t k = 0; k < 3; ++k) {
                ASSERT_GE(x[k], bounds.low[k]) << region.is.index();
                ASSERT_LE(x[k], bounds.high[k]) << region.is.index();
            }
        }
    }
    EXPECT_EQ(box().bounds().high[1], 2);
    EXPECT_EQ(hollow().bounds().low, (Vec3{-2, -2, -1}));
    EXPECT_EQ(hollow().bounds().high, (Vec3{2, 2, 3}));
    const double s = std::numbers::sqrt2 / 2;
    EXPECT_NEAR(tilted().bounds().low[0], 1 - 1.5 * s, 1e-15);
    EXPECT_NEAR(tilted().bounds().high[2], (2 + 1.5) * s, 1e-15);
    EXPECT_EQ(ball().bounds().low, (Vec3{-1, -1.5, -0.5}));
    EXPECT_EQ(above().bounds().low, (Vec3{-infinity, -infinity, 1}));
    EXPECT_EQ(above().bounds().high[2], infinity);
    EXPECT_EQ((Region{Region::Half{{0, 0, 1}, {0, 0, -1}}}.bounds().high[2]), 1);
    EXPECT_EQ((Region{Region::All{{box(), above()}}}.bounds().low), (Vec3{-1, -2, 1}));
    EXPECT_EQ((Region{Region::Any{{box(), ball()}}}.bounds().high), (Vec3{2, 2, 3}));
    EXPECT_EQ((Region{Region::Not{{box()}}}.bounds().low[0]), -infinity);
}

TEST(MachineRegions, VolumesAreThoseOfTheBodies) {
    EXPECT_DOUBLE_EQ(box().volume().value(), 24);
    EXPECT_DOUBLE_EQ(hollow().volume().value(), std::numbers::pi * (4 - 0.25) * 4);
    EXPECT_DOUBLE_EQ(ball().volume().value(), 4 * std::numbers::pi / 3 * 1.5 * 1.5 * 1.5);
    // Monte Carlo within five standard errors: the depth, bounds and volume speak of the same body.
    for (const Region& region : {box(), hollow(), tilted(), ball()}) {
        constexpr std::uint64_t points = 20000;
        double inside = 0;
        for (std::uint64_t n = 0; n < points; ++n) inside += region.contains(random_point(n, 4)) ? 1 : 0;
        const double share = region.volume().value() / 512, error = std::sqrt(share * (1 - share) / points);
        EXPECT_NEAR(inside / points, share, 5 * error) << region.is.index();
    }
    EXPECT_FALSE(above().volume());
    EXPECT_FALSE((Region{Region::All{{box()}}}.volume()));
    EXPECT_FALSE((Region{Region::Any{{box()}}}.volume()));
    EXPECT_FALSE((Region{Region::Not{{box()}}}.volume()));
}

/// Periodic along x with the period 4, from -2 to 2.
geometry::Domain periodic_domain() {
    return {{-2, -5, -5}, {2, 5, 5}, {true, false, false}};
}

// By the images of the point, tried one by one.
TEST(MachineRegions, HaveImagesAcrossPeriodicFaces) {
    const geometry::Domain domain = periodic_domain();
    const Region across{Region::Box{{1, -2, 0}, {3, 2, 3}}};
    const std::vector<Region> regions = {across,
                                         hollow(),
                                         {Region::Ball{{-1.8, 0, 1}, 1.5}},
                                         {Region::All{{across, {Region::Half{{2.5, 0, 0}, {1, 0, 0}}}}}},
                                         {Region::Any{{across, above()}}},
                                         {Region::Not{{across}}}};
    for (std::size_t r = 0; r < regions.size(); ++r) {
        const Region imaged = machine::with_images(regions[r], domain);
        int beyond = 0;
        for (std::uint64_t n = 0; n < 3000; ++n) {
            Vec3 x = random_point(n, 5);
            x = x + domain.wrapping(x);
            // A combination that holds everywhere else has images where it has an edge: of its box.
            const bool outside = std::holds_alternative<Region::Not>(regions[r].is);
            const Region& tried = outside ? across : regions[r];
            bool inside = false;
            for (const double period : {-4.0, 0.0, 4.0}) inside = inside || tried.contains(x + Vec3{period, 0, 0});
            if (outside) inside = !inside;
            ASSERT_EQ(imaged.contains(x), inside) << r << " " << x[0] << " " << x[1] << " " << x[2];
            beyond += imaged.contains(x) != regions[r].contains(x) ? 1 : 0;
        }
        EXPECT_TRUE(r == 1 || beyond > 20) << r << ": the regions of this test reach beyond a face, but for the second";
    }
}

TEST(MachineRegions, WithinTheFacesStayThemselves) {
    for (const Region& region : {box(), above(), Region{Region::All{{box(), ball()}}}})
        EXPECT_EQ(machine::with_images(region, periodic_domain()).is.index(), region.is.index());
    EXPECT_EQ(machine::with_images({Region::Ball{{9, 0, 0}, 1}}, {{-2, -5, -5}, {2, 5, 5}, {}}).is.index(),
              Region(ball()).is.index())
        << "the faces are open";
}

// A wall moves it by 1.5 along x, so that a box within the faces reaches beyond them.
TEST(MachineRegions, HaveImagesWhereTheyMove) {
    const geometry::Domain domain = periodic_domain();
    const auto moved = std::make_shared<const Vec3>(Vec3{1.5, 0, 0});
    const auto moving = [&](const Region& inner) {
        Region region{Region::Moving{{inner}, 0, std::nullopt, nullptr}};
        region = machine::with_images(std::move(region), domain);
        std::get<Region::Moving>(region.is).moved = moved;
        return region;
    };
    const Region region = moving({Region::Box{{0, -1, 0}, {1, 1, 1}}});  // at 1.5 to 2.5, so that it begins anew at -2
    EXPECT_TRUE(region.contains({1.6, 0, 0.5}));
    EXPECT_TRUE(region.contains({-1.6, 0, 0.5}));
    EXPECT_FALSE(region.contains({-1.4, 0, 0.5}));
    EXPECT_FALSE(region.contains({0.5, 0, 0.5}));
    const Region endless = moving({Region::Box{{-100, -1, 0}, {100, 1, 1}}});
    for (const double x : {-2.0, -0.3, 1.9}) {
        EXPECT_TRUE(endless.contains({x, 0, 0.5}));
        EXPECT_FALSE(endless.contains({x, 1.1, 0.5}));
    }
}

TEST(MachineRegions, LongerThanThePeriodCountEachPointOnce) {
    const geometry::Domain domain = periodic_domain();
    const auto volume_of = [&](Region region) { return machine::with_images(std::move(region), domain).volume(); };
    EXPECT_DOUBLE_EQ(volume_of({Region::Box{{-9, 0, 0}, {9, 1, 1}}}).value(), 4);
    EXPECT_DOUBLE_EQ(volume_of({Region::Box{{1, 0, 0}, {4, 1, 1}}}).value(), 3);
    EXPECT_DOUBLE_EQ(volume_of({Region::Round{{-9, 0, 0}, {1, 0, 0}, 1, 0, 18}}).value(), 4 * std::numbers::pi);
    EXPECT_DOUBLE_EQ(volume_of({Region::Round{{9, 0, 0}, {-1, 0, 0}, 1, 0, 18}}).value(), 4 * std::numbers::pi);
    EXPECT_DOUBLE_EQ(volume_of({Region::Ball{{1.5, 0, 0}, 1}}).value(), 4 * std::numbers::pi / 3);
    EXPECT_FALSE(volume_of({Region::Ball{{0, 0, 0}, 2.5}})) << "its images overlap";
    EXPECT_TRUE(machine::with_images({Region::Round{{9, 0, 0}, {-1, 0, 0}, 1, 0, 18}}, domain).contains({-1.9, 0, 0}));
    // Bodies of hundreds of periods, as an `all` with a box "everywhere along x" has them.
    const Region far{Region::All{{{Region::Box{{-1e3, -1, 0}, {1e3, 1, 2}}}, {Region::Ball{{0, 0, 0}, 1e4}}}}};
    for (std::uint64_t n = 0; n < 500; ++n) {
        const Vec3 x = random_point(n, 2);
        EXPECT_EQ(machine::with_images(far, domain).contains(x), std::abs(x[1]) <= 1 && x[2] >= 0 && x[2] <= 2);
    }
}

TEST(MachineRegions, WrongNumbersHaveASentence) {
    const auto flaw = [](const Region& region) { return std::string(region.flaw()); };
    for (const Region& region : all_kinds()) EXPECT_EQ(flaw(region), "");
    EXPECT_EQ(flaw({Region::Box{{0, 0, 0}, {1, 0, 1}}}), "\"low\" of a box must lie below \"high\" along every axis");
    EXPECT_NE(flaw({Region::Round{{}, {0, 0, 1}, 0, 0, 1}}), "");
    EXPECT_NE(flaw({Region::Round{{}, {0, 0, 1}, 1, 0, -1}}), "");
    EXPECT_NE(flaw({Region::Round{{}, {0, 0, 2}, 1, 0, 1}}), "");
    EXPECT_NE(flaw({Region::Round{{}, {0, 0, 1}, 1, 1, 1}}), "") << "nothing is between the radii";
    EXPECT_NE(flaw({Region::Round{{}, {0, 0, 1}, 1, -0.1, 1}}), "");
    EXPECT_NE(flaw({Region::Ball{{}, 0}}), "");
    EXPECT_NE(flaw({Region::Half{{}, {0, 0, 0}}}), "");
    EXPECT_NE(flaw({Region::All{{}}}), "");
    EXPECT_NE(flaw({Region::Any{{box(), {Region::Ball{{}, -1}}}}}), "") << "within a combination, too";
}

}  // namespace grainsweep::tests::machine_regions_test
