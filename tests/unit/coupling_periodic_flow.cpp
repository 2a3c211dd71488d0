#include "solver/coupling/periodic_flow.hpp"
#include "solver/coupling/visit_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace grainsweep::tests::coupling_periodic_flow_test {

using namespace coupling;

constexpr double pi = 3.14159265358979323846;

flow::Grid cube(int n) {
    const auto axis = flow::Axis::uniform(n, -0.5, 0.5);
    return {{axis, axis, axis}};
}

// Fields whose every node oscillates with a mean, two harmonics and a fifth that is not kept.
flow::FaceVectors field_at(const flow::Grid& grid, double phase, double fifth, std::uint64_t stream) {
    const stats::Stream random(9, stream);
    auto field = flow::face_vectors(grid);
    std::uint64_t draw = 0;
    for (auto& component : field)
        for (double& v : component.values()) {
            const auto amplitude = [&] { return random.uniform(draw++) - 0.5; };
            v = amplitude();
            v += amplitude() * std::cos(phase) + amplitude() * std::sin(phase);
            v += amplitude() * std::cos(2 * phase) + amplitude() * std::sin(2 * phase);
            v += fifth * amplitude() * std::cos(5 * phase);
        }
    return field;
}

// Sixteen equidistant samples determine the five terms exactly, and a fifth harmonic does not leak into them.
TEST(PeriodicFlow, GivesBackWhatItKeepsAtEveryPhase) {
    const auto grid = cube(5);
    PeriodSum period(grid);
    constexpr int samples = 16;
    for (int s = 0; s < samples; ++s) {
        const double phase = 2 * pi * (s + 0.5) / samples;
        period.add(phase, samples, field_at(grid, phase, 1, 1), field_at(grid, phase, 1, 2));
    }
    const PeriodicFlow periodic(grid, period);
    const Stencil<Trilinear> stencil(grid, {}, {0.13, -0.21, 0.37});
    // Five amplitudes of up to a half, kept, weighted and summed in single precision.
    constexpr double rounded = 5 * 0.5 * 4 * 6e-8;
    for (const double phase : {0.0, 0.1, 2.0, 6.0}) {
        const auto around = periodic.at(stencil, phase);
        const Vec3 velocity = stencil.gather(field_at(grid, phase, 0, 1));
        const Vec3 acceleration = stencil.gather(field_at(grid, phase, 0, 2));
        for (std::size_t d = 0; d < 3; ++d) {
            EXPECT_NEAR(around.velocity[d], velocity[d], rounded);
            EXPECT_NEAR(around.acceleration[d], acceleration[d], rounded);
        }
    }
}

TEST(PeriodicFlow, IsTheSameAfterAStay) {
    const auto grid = cube(4);
    PeriodSum period(grid);
    period.add(0.3, 1, field_at(grid, 0.3, 0, 1), field_at(grid, 0.3, 0, 2));
    const PeriodicFlow kept(grid, period);
    std::vector<std::byte> bytes;
    kept.save(bytes);
    PeriodicFlow found(grid);
    std::span<const std::byte> from(bytes);
    found.restore(from);
    EXPECT_TRUE(from.empty());
    const Stencil<Trilinear> stencil(grid, {}, {0.1, 0.2, 0.3});
    EXPECT_EQ(kept.at(stencil, 1.0).velocity, found.at(stencil, 1.0).velocity);
    EXPECT_EQ(kept.at(stencil, 1.0).acceleration, found.at(stencil, 1.0).acceleration);
    std::span<const std::byte> half(bytes.data(), bytes.size() / 2);
    EXPECT_THROW(found.restore(half), std::invalid_argument);
}

TEST(VisitOrder, VisitsEveryParticleOnceNeighboursTogether) {
    const auto grid = cube(8);
    const Walls box{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}, {}, 0, 1};
    const Cloud cloud = random_cloud(500, box, stats::Stream(1, 1));
    VisitOrder visits;
    auto order = visits.of(cloud, grid);
    for (std::size_t m = 1; m < order.size(); ++m)  // planes of cells are visited from below
        EXPECT_LE(grid[2].locate(cloud.position[order[m - 1]][2]).cell,
                  grid[2].locate(cloud.position[order[m]][2]).cell);
    std::ranges::sort(order);
    for (std::uint32_t p = 0; p < 500; ++p) EXPECT_EQ(order[p], p);
}

}  // namespace grainsweep::tests::coupling_periodic_flow_test
