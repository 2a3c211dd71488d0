// The written-out elementary functions against the library's, and many particles at once against one by one.
#include "solver/coupling/march.hpp"
#include "stats/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace grainsweep::tests::coupling_march_test {

using namespace coupling;
using stats::Stream;

constexpr double ulp = std::numeric_limits<double>::epsilon();

TEST(Elementary, ExponentialIsThatOfTheLibrary) {
    const Stream random(1, 1);
    for (std::uint64_t n = 0; n < 20000; ++n) {
        const double size = std::pow(10, 4 * random.uniform(2 * n) - 2);
        for (const double x : {-size * random.uniform(2 * n + 1), -std::pow(10, -20 * random.uniform(2 * n + 1)),
                               7 * random.uniform(2 * n + 1)}) {
            const Exponential e = exponential(x);
            EXPECT_NEAR(e.value(), std::exp(x), 2 * ulp * std::exp(x)) << x;
            EXPECT_NEAR(e.less_one(), std::expm1(x), 2 * ulp * std::abs(std::expm1(x))) << x;
        }
    }
    EXPECT_EQ(exponential(0).value(), 1);
    EXPECT_EQ(exponential(-1e300).value(), exponential(-700).value());
    EXPECT_EQ(exponential(-1e300).less_one(), -1);
    EXPECT_EQ(exponential(-std::numeric_limits<double>::infinity()).less_one(), -1);
    EXPECT_TRUE(std::isnan(exponential(std::nan("")).value()));
}

TEST(Elementary, LogarithmIsThatOfTheLibrary) {
    const Stream random(1, 2);
    for (std::uint64_t n = 0; n < 20000; ++n)
        for (const double x : {std::pow(10, 600 * random.uniform(2 * n) - 300), 0.5 + random.uniform(2 * n + 1)})
            EXPECT_NEAR(logarithm(x), std::log(x), 2 * ulp * std::abs(std::log(x)) + 1e-18) << x;
    EXPECT_EQ(logarithm(1), 0);
}

TEST(SchillerNaumannDrag, IsOneAtRestAndThePrintedLawBeyond) {
    EXPECT_EQ(SchillerNaumann::factor(0), 1);
    EXPECT_EQ(SchillerNaumann::factor(1e-320), 1);
    for (const double re : {1e-8, 1e-3, 0.3, 1.0, 77.0, 800.0})
        EXPECT_NEAR(SchillerNaumann::factor(re), 1 + 0.15 * std::pow(re, 0.687), 1e-14 * SchillerNaumann::factor(re));
}

// A cloud of every size of block, in any order, with walls: bit for bit what each particle does on its own.
template <class Drag>
void expect_the_same_bits(const Sphere& sphere, double dt) {
    const Motion<Drag> motion(sphere, dt);
    const Walls box{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, {}, 0.01, 0.8};
    const Stream random(2, 3);
    for (const std::size_t count : {std::size_t{1}, std::size_t{63}, std::size_t{64}, std::size_t{200}}) {
        Cloud cloud = random_cloud(count, box, Stream(4, 1));
        for (std::uint64_t p = 0; p < count; ++p)
            for (std::size_t d = 0; d < 3; ++d) cloud.velocity[p][d] = 200 * (random.uniform(3 * p + d) - 0.5);
        const auto around = [&](std::size_t p) {
            const Vec3 x = cloud.position[p];
            return Surroundings{{90 * x[1], -40 * x[2], 70 * x[0]},
                                {1e4 * x[2], 3e4 * x[0], -2e4 * x[1]},
                                0.7,
                                {-1e3 * x[0], 7e3 * x[1], 0}};
        };
        Cloud alone = cloud;
        for (std::size_t p = 0; p < count; ++p) {
            motion.advance(alone.position[p], alone.velocity[p], around(p));
            box.apply(alone.position[p], alone.velocity[p]);
        }
        std::vector<std::uint32_t> order(count);
        std::iota(order.rbegin(), order.rend(), 0U);
        Cloud together = cloud;
        std::vector<int> visits(count, 0);
        march(
            together, motion, box, 0.7, order, [](std::size_t p) { return p; },
            [&](std::size_t p, std::size_t stood) {
                EXPECT_EQ(p, stood);
                return around(p);
            },
            [&](std::size_t p, const Vec3& before) {
                ++visits[p];
                EXPECT_EQ(before, cloud.velocity[p]);
            });
        EXPECT_EQ(together.position, alone.position);
        EXPECT_EQ(together.velocity, alone.velocity);
        EXPECT_EQ(visits, std::vector<int>(count, 1));
    }
}

TEST(March, ChangesNoBit) {
    for (const double stokes : {1e-9, 3.1e-6, 1e-4})
        for (const double dt : {1e-8, 1e-5, 1e-3}) {
            const Sphere sphere{1.65, stokes, 18, 1.7e9, 1};
            expect_the_same_bits<SchillerNaumann>(sphere, dt);
            expect_the_same_bits<StokesDrag>(sphere, dt);
        }
}

}  // namespace grainsweep::tests::coupling_march_test
