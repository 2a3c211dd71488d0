// No contact may ever be missed: after every step of violent runs the largest overlap the engine reports must be that
// of a search over all pairs, and the kinetic energy of an elastic cloud must stay.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "solver/dem/fast/mixed_engine.hpp"
#include "stats/random.hpp"
#include "tests/support/granular_scenes.hpp"

namespace grainsweep::tests::fast_lists_test {

using dem::Method;

/// Largest overlap over the smaller diameter, over all pairs of which one moves.
double largest_overlap(const dem::State& s, const dem::Domain& domain) {
    double most = 0;
    for (std::size_t i = 0; i < s.id.size(); ++i)
        for (std::size_t j = i + 1; j < s.id.size(); ++j) {
            if (s.mobile[i] == 0 && s.mobile[j] == 0) continue;
            const double reach = s.radius[i] + s.radius[j];
            double square = 0;
            for (std::size_t a = 0; a < 3; ++a) {
                double d = s.position[i][a] - s.position[j][a];
                const double period = domain.high[a] - domain.low[a];
                if (domain.periodic[a]) d -= period * std::nearbyint(d / period);
                square += d * d;
            }
            if (square < reach * reach)
                most = std::max(most, (reach - std::sqrt(square)) / (2 * std::min(s.radius[i], s.radius[j])));
        }
    return most;
}

void watch(const dem::Setup& setup, Method::Path path, int steps) {
    const auto engine = dem::fast::make_mixed_engine(setup, path);
    double smallest = 1, largest = 0;
    for (const auto& p : setup.spheres) smallest = std::min(smallest, p.radius), largest = std::max(largest, p.radius);
    // the sum of two radii is rounded to single precision, positions to their units: 3e-8 largest diameters each
    const double rounding = 6e-8 * largest / smallest;
    dem::State state;
    int contacts = 0;
    for (int k = 0; k < steps; ++k) {
        engine->run(1);
        ASSERT_EQ(engine->fault(), "") << "step " << k;
        engine->state(state);
        const double expected = largest_overlap(state, setup.domain);
        ASSERT_NEAR(engine->largest_overlap(), expected, 1e-6 * expected + rounding) << "step " << k;
        contacts += expected > 0 ? 1 : 0;
    }
    EXPECT_GT(contacts, steps / 2) << "a test of contacts needs contacts";
    EXPECT_GE(engine->work().rebuilds, 3);
}

/// Few enough pairs that the deepest contact changes hands often.
dem::Setup violent(int per_side, double spread, std::uint64_t seed) {
    dem::Setup s = tests::thrown_lattice(per_side, 2.0, spread, seed);
    s.time_step = 2e-6;
    s.material.restitution = 0.95;
    return s;
}

TEST(FastLists, DeepestContactIsAlwaysTheDeepest) {
    for (const auto path : {Method::Path::baseline, Method::Path::avx2, Method::Path::avx512}) {
        if (!dem::fast::supports(path)) continue;
        watch(violent(4, 0, 1), path, 1500);
        watch(violent(5, 0.3, 2), path, 700);
    }
}

TEST(FastLists, SizesOneToTwenty) {
    dem::Setup s = tests::thrown_lattice(3, 0, 0, 3);
    s.spheres.clear();
    const stats::Stream stream(5, 5);
    std::uint64_t draw = 0;
    const double side = s.domain.high[0] - s.domain.low[0];
    for (int k = 0; k < 320; ++k) {  // a few large ones, then small ones wherever there is room
        dem::Sphere p;
        p.radius = k < 8 ? 0.5e-3 : k == 8 ? 0.025e-3 : 0.025e-3 * (1 + 3 * stream.uniform(draw++));
        bool free = false;
        while (!free) {
            for (std::size_t a = 0; a < 3; ++a) {
                p.position[a] = s.domain.low[a] + side * stream.uniform(draw++);
                p.velocity[a] = 2 * stream.uniform(draw++) - 1;
            }
            free = std::none_of(s.spheres.begin(), s.spheres.end(), [&](const dem::Sphere& q) {
                double square = 0;
                for (std::size_t a = 0; a < 3; ++a) {
                    const double d = std::abs(p.position[a] - q.position[a]);
                    square += std::pow(std::min(d, side - d), 2);
                }
                return square < std::pow(p.radius + q.radius, 2);
            });
        }
        s.spheres.push_back(p);
    }
    s.material.youngs_modulus = 1e9;
    s.time_step = 2e-8;
    watch(s, Method::Path::best, 6000);
}

TEST(FastLists, ClustersMeetAtSpeed) {
    // two dense clusters fly into each other across a periodic face
    dem::Setup s = tests::thrown_lattice(4, 0.1, 0, 4);
    const double length = s.domain.high[0] - s.domain.low[0];
    s.domain.high[0] += 2 * length;
    for (std::size_t i = 0; i < s.spheres.size(); ++i) s.spheres[i].velocity[0] += 4;
    const std::size_t n = s.spheres.size();
    for (std::size_t i = 0; i < n; ++i) {
        dem::Sphere p = s.spheres[i];
        p.position[0] += 1.2 * length;
        p.velocity[0] -= 8;
        s.spheres.push_back(p);
    }
    s.time_step = 1e-6;
    watch(s, Method::Path::best, 3000);
}

TEST(FastLists, AnElasticGasKeepsItsEnergy) {
    dem::Setup s = tests::thrown_lattice(6, 1.0, 0.1, 6);
    for (std::size_t a = 0; a < 3; ++a) s.domain.high[a] += 4e-3;
    s.material.restitution = 1;
    s.material.friction = 0;
    s.time_step = 1e-6;
    const auto engine = dem::fast::make_mixed_engine(s, Method::Path::best);
    dem::State state;
    const auto energy = [&] {
        engine->state(state);
        double e = 0;
        for (std::size_t i = 0; i < state.id.size(); ++i)
            for (const double v : state.velocity[i]) e += std::pow(state.radius[i], 3) * v * v;
        return e;
    };
    const double start = energy();
    for (int k = 0; k < 40; ++k) {
        engine->run(500);
        // what is stored in contacts is missing for a while; a missed contact would give energy back as overlap
        const double now = energy() / start;
        EXPECT_LT(now, 1.002);
        EXPECT_GT(now, 0.9);
    }
}

}  // namespace grainsweep::tests::fast_lists_test
