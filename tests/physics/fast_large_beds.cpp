// A bed that no cache holds, whose contact histories are written past the caches, moves as a small one does: many small
// periodic beds side by side are the small bed, many times.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "solver/dem/fast/mixed_engine.hpp"
#include "stats/random.hpp"
#include "tests/support/against_plain.hpp"
#include "tests/support/granular_beds.hpp"

namespace grainsweep::tests::fast_large_beds_test {

using dem::fast::make_mixed_engine;

constexpr int along = 13;    // beds along x and along y
constexpr int steps = 240;   // 0.12 ms: what lies on others slides off, histories grow and begin
constexpr double d = 45e-6;  // m

/// 768 spheres that slide in all directions at once: contacts that stay, slip, begin and end.
dem::Setup small_bed(double spread) {
    dem::Setup bed = tests::settled_bed({.per_side = 8, .layers = 12, .spread = spread, .settle_time = 1e-3});
    bed = tests::tilted(bed, 26);
    for (std::size_t i = 0; i < bed.spheres.size(); ++i)
        if (auto& p = bed.spheres[i]; p.mobile) p.velocity[i % 2] += i % 3 == 0 ? 0.02 : -0.01;
    return bed;
}

/// Every position by up to 1e-7 diameters along every axis.
dem::Setup moved_a_little(dem::Setup bed, std::uint64_t seed) {
    const stats::Stream stream(seed, 1);
    std::uint64_t draw = 0;
    for (auto& p : bed.spheres)
        for (double& x : p.position) x += 1e-7 * d * (2 * stream.uniform(draw++) - 1);
    return bed;
}

struct Difference {
    double position = 0, velocity = 0;  ///< diameters; of the largest speed
};

/// Of the large bed's copies from the small one; a period along x or y is no difference.
Difference of_copies(const dem::Setup& small, const dem::State& one, const dem::State& all) {
    std::vector<std::size_t> place(small.spheres.size());
    for (std::size_t k = 0; k < one.id.size(); ++k) place[static_cast<std::size_t>(one.id[k])] = k;
    Difference found;
    double speed = 0;
    for (const auto& v : one.velocity) speed = std::max(speed, std::hypot(v[0], v[1], v[2]));
    for (std::size_t k = 0; k < all.id.size(); ++k) {
        const std::size_t same = place[static_cast<std::size_t>(all.id[k]) % small.spheres.size()];
        for (std::size_t a = 0; a < 3; ++a) {
            double apart = all.position[k][a] - one.position[same][a];
            const double period = small.domain.high[a] - small.domain.low[a];
            if (a < 2) apart -= period * std::round(apart / period);
            found.position = std::max(found.position, std::abs(apart) / d);
            found.velocity = std::max(found.velocity, std::abs(all.velocity[k][a] - one.velocity[same][a]) / speed);
        }
    }
    return found;
}

class FastLargeBeds : public testing::TestWithParam<double> {};

TEST_P(FastLargeBeds, ManySmallBedsSideBySideMoveAsOne) {
    const dem::Setup small = small_bed(GetParam());
    const dem::Setup large = tests::replicated(small, along, along);
    ASSERT_GT(large.spheres.size(), 120'000U) << "as many as leave the caches";
    for (const auto path : tests::paths()) {
        SCOPED_TRACE(tests::path_name(path));
        const auto after = [&](const dem::Setup& setup) {
            const auto engine = make_mixed_engine(setup, path);
            engine->run(steps);
            EXPECT_EQ(engine->fault(), "");
            dem::State state;
            engine->state(state);
            return state;
        };
        const dem::State one = after(small);
        Difference grown;  // of starts moved by two units of single precision
        for (std::uint64_t k = 0; k < 4; ++k) {
            const auto moved = of_copies(small, one, after(moved_a_little(small, k)));
            grown.position = std::max(grown.position, moved.position);
            grown.velocity = std::max(grown.velocity, moved.velocity);
        }
        ASSERT_LT(grown.position, 1e-3) << "too long to compare step by step";
        const dem::State all = after(large);
        ASSERT_EQ(all.id.size(), large.spheres.size());
        const auto difference = of_copies(small, one, all);
        EXPECT_LT(difference.position, grown.position);
        EXPECT_LT(difference.velocity, grown.velocity);
    }
}

TEST_P(FastLargeBeds, SeveralThreadsAndACheckpointKeepEveryBit) {
    const dem::Setup large = tests::replicated(small_bed(GetParam()), along, along);
    const auto path = tests::paths().back();
    const auto bytes_of = [](const dem::Engine& engine) {
        std::vector<std::byte> bytes;
        engine.save(bytes);
        return bytes;
    };
    const auto one = make_mixed_engine(large, path, 0, 0, {.most = 1});
    one->run(steps / 2);
    const auto half = bytes_of(*one);
    one->run(steps / 2);
    const auto whole = bytes_of(*one);
    for (const int threads : {2, 3}) {
        const auto several = make_mixed_engine(large, path, 0, 0, {.most = threads});
        several->run(steps);
        EXPECT_EQ(bytes_of(*several), whole) << threads << " threads";
        several->restore(half);
        several->run(steps / 2);
        EXPECT_EQ(bytes_of(*several), whole) << threads << " threads, restored";
    }
}

INSTANTIATE_TEST_SUITE_P(Sizes, FastLargeBeds, testing::Values(0.0, 0.25),
                         [](const auto& tested) { return tested.param > 0 ? "Unequal" : "Equal"; });

}  // namespace grainsweep::tests::fast_large_beds_test
