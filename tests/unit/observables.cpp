#include "solver/observables/accumulation.hpp"
#include "solver/observables/flow_state.hpp"
#include "stats/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace grainsweep::tests::observables_test {

using namespace observables;

const Box cube{{-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5}};

std::vector<Vec3> random_cloud(std::size_t n, std::uint64_t stream) {
    const stats::Stream random(11, stream);
    std::vector<Vec3> cloud;
    for (std::size_t p = 0; p < n; ++p)
        cloud.push_back(
            {random.uniform(3 * p) - 0.5, random.uniform(3 * p + 1) - 0.5, random.uniform(3 * p + 2) - 0.5});
    return cloud;
}

/// Returns the smallest possible K of N particles on this number of cells.
double least_accumulation(std::size_t particles, std::size_t cells) {
    const auto n = static_cast<double>(particles);
    const double lambda = n / static_cast<double>(cells);
    const double f = lambda - std::floor(lambda);
    return static_cast<double>(cells) * f * (1 - f) / (n - lambda);
}

TEST(Accumulation, IsOneInOneCellAndZeroOnePerCell) {
    const std::vector<Vec3> point(500, Vec3{0.1, 0.1, 0.1});
    EXPECT_NEAR(accumulation(cell_counts(point, cube, 7)), 1, 1e-13);
    std::vector<Vec3> lattice;
    for (int i = 0; i < 64; ++i)
        lattice.push_back({(i % 4 + 0.5) / 4 - 0.5, (i / 4 % 4 + 0.5) / 4 - 0.5, (i / 16 + 0.5) / 4 - 0.5});
    EXPECT_EQ(accumulation(cell_counts(lattice, cube, 4)), 0);
    EXPECT_TRUE(std::isnan(accumulation(cell_counts(std::vector<Vec3>(1), cube, 4))));
}

// Monte-Carlo means and standard deviations over clouds of 3150 particles, and the least values.
TEST(Accumulation, OfARandomCloudIsTheExpectedOne) {
    struct Row {
        int n;
        double random, sd, least;
    };
    for (const Row& row :
         {Row{5, 0.0798, 0.0055, 0.0064}, Row{8, 0.1605, 0.0053, 0.0210}, Row{10, 0.2234, 0.0050, 0.0405},
          Row{20, 0.6746, 0.0021, 0.6063}, Row{40, 0.95199, 0.00014, 0.95080}}) {
        const auto cells =
            static_cast<std::size_t>(row.n) * static_cast<std::size_t>(row.n) * static_cast<std::size_t>(row.n);
        EXPECT_NEAR(random_accumulation(3150, cells), row.random, 6e-5) << row.n;
        EXPECT_NEAR(least_accumulation(3150, cells), row.least, 6e-5) << row.n;
        double mean = 0;
        constexpr int clouds = 20;
        for (std::uint64_t c = 0; c < clouds; ++c)
            mean += accumulation(cell_counts(random_cloud(3150, c), cube, row.n)) / clouds;
        EXPECT_NEAR(mean, row.random, 3 * row.sd / std::sqrt(clouds) + 6e-5) << row.n;
    }
}

TEST(DensityProfile, IsOneForALattice) {
    std::vector<Vec3> lattice;
    for (int i = 0; i < 1000; ++i) lattice.push_back({0, (i + 0.5) / 1000 - 0.5, 0.49});
    for (const double share : density_profile(lattice, cube, 10, 1)) EXPECT_NEAR(share, 1, 1e-12);
    EXPECT_NEAR(density_profile(lattice, cube, 10, 2)[9], 10, 1e-12);
}

TEST(Structures, AreCountedOncePerBand) {
    const int n = 10;
    EXPECT_EQ(structures(cell_counts(random_cloud(3150, 3), cube, n), n), 0);
    auto cloud = random_cloud(1500, 4);
    const auto extra = random_cloud(3300, 5);
    for (std::size_t p = 0; p < extra.size(); ++p)  // two bands across the box, one cell wide
        cloud.push_back({extra[p][0], p % 2 == 0 ? -0.35 : 0.25, 0.1 * extra[p][2]});
    EXPECT_EQ(structures(cell_counts(cloud, cube, n), n), 2);
}

// With one particle in twenty cells every particle is far above twice the mean.
TEST(Structures, AreUndefinedForTooFewParticles) {
    const int n = 10;
    EXPECT_TRUE(std::isnan(structures(cell_counts(random_cloud(20, 3), cube, n), n)));
    EXPECT_TRUE(std::isnan(structures(cell_counts(random_cloud(499, 3), cube, n), n)));
    EXPECT_EQ(structures(cell_counts(random_cloud(500, 3), cube, n), n), 0);
}

TEST(FormationTime, IsWhenTheSeriesStaysNearItsEnd) {
    const std::vector<double> t = {0, 1, 2, 3, 4, 5};
    const std::vector<double> k = {0, 0.95, 0.5, 0.91, 0.99, 1};
    EXPECT_EQ(formation_time(t, k, 0.02), 3);
    EXPECT_EQ(formation_time(t, k, 0.17), 1) << "0.5 is within three deviations of 1";
    EXPECT_TRUE(std::isnan(formation_time(t, k, 0.21))) << "a rise of less than five deviations";
    EXPECT_TRUE(std::isnan(formation_time({}, {}, 0)));
    std::vector<double> steady, settled;
    for (const double time : t) {
        steady.push_back(time);
        settled.push_back(std::min(time, 4.4));
    }
    EXPECT_TRUE(std::isnan(formation_time(t, steady, 0))) << "still rising";
    EXPECT_EQ(formation_time(t, settled, 0), 4);
}

TEST(Gershuni, IsThePublishedNumber) {
    EXPECT_NEAR(gershuni(18, 4.81e5, 1.667e4), 7.49e3, 5);
    EXPECT_NEAR(gershuni(18, 1.77e6, 2.33e4), 5.19e4, 50);
    EXPECT_NEAR(gershuni(18, 3.04e5, 2.33e4), 1.53e3, 5);
}

TEST(KineticEnergy, OfAUniformStreamIsExact) {
    const flow::Grid grid{{flow::Axis::uniform(6, 0, 2), flow::Axis::uniform(4, 0, 1), flow::Axis::uniform(3, 0, 1)}};
    auto velocity = flow::face_vectors(grid);
    for (double& v : velocity[1].values()) v = 3;  // as along a periodic axis
    EXPECT_NEAR(observables::kinetic_energy(grid, velocity), 4.5, 1e-14);
    EXPECT_EQ(peak_velocity(grid, velocity), 3);
}

TEST(Nusselt, OfConductionIsOne) {
    const auto axis = flow::Axis::clustered(9, -0.5, 0.5, 1.5);
    const flow::Grid grid{{axis, axis, axis}};
    flow::Field theta(grid);
    for (int k = 0; k <= 10; ++k)
        for (int j = 0; j <= 10; ++j)
            for (int i = 0; i <= 10; ++i) theta(i, j, k) = axis.centre(k);
    EXPECT_NEAR(nusselt(grid, theta, 2, 1, 0.5), 1, 1e-13);
    EXPECT_NEAR(nusselt(grid, theta, 2, 0, -0.5), 1, 1e-13);
}

}  // namespace grainsweep::tests::observables_test
