// A generated packing against packings of the same fraction made by another program (packings/*.npz of the
// tpms reference: FIRE from random points, two of edge 20 and one of edge 30). Tolerances are four times the
// scatter between those three.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "solver/particles/packing.hpp"

namespace grainsweep::tests::packing_statistics_test {

using namespace particles;

/// Distances below 2.5 diameters between nearest images, all pairs tried; and contacts per sphere.
struct Statistics {
    std::vector<int> histogram = std::vector<int>(50, 0);  // bins of 0.05 diameters
    std::vector<int> contacts;                             // gap below 0.5 %
    double largest_overlap = 0;
    int within_2_percent = 0, within_10_percent = 0;

    explicit Statistics(const Packing& packing) : contacts(packing.positions.size(), 0) {
        const auto& x = packing.positions;
        for (std::size_t i = 0; i < x.size(); ++i)
            for (std::size_t j = i + 1; j < x.size(); ++j) {
                double square = 0;
                for (std::size_t k = 0; k < 3; ++k) {
                    const double d = std::abs(x[i][k] - x[j][k]);
                    const double nearest = std::min(d, packing.edge - d);
                    square += nearest * nearest;
                }
                if (square < 6.25) add(i, j, std::sqrt(square));
            }
    }
    void add(std::size_t i, std::size_t j, double r) {
        ++histogram[static_cast<std::size_t>(r / 0.05)];
        largest_overlap = std::max(largest_overlap, 1 - r);
        within_2_percent += r < 1.02 ? 1 : 0;
        within_10_percent += r < 1.1 ? 1 : 0;
        if (r >= 1.005) return;
        ++contacts[i];
        ++contacts[j];
    }
    [[nodiscard]] double per_sphere(double pairs) const { return 2 * pairs / static_cast<double>(contacts.size()); }
    /// Pair correlation in the bin that starts at r.
    [[nodiscard]] double g(double r, double edge) const {
        const auto bin = static_cast<std::size_t>(std::lround(r / 0.05));
        const double shell = 4 * std::numbers::pi / 3 * (std::pow(r + 0.05, 3) - std::pow(r, 3));
        const double density = static_cast<double>(contacts.size()) / std::pow(edge, 3);
        return per_sphere(histogram[bin]) / (shell * density);
    }
};

TEST(PackingStatistics, AgreeWithThoseOfAnotherProgram) {
    const Packing packing = random_close_packing({20, 0.62, 1, 2e-5});
    ASSERT_EQ(packing.positions.size(), 9473U);  // round(6 x 0.62 x 8000/pi), the reference's own count
    const Statistics s(packing);

    EXPECT_LT(s.largest_overlap, 2e-5);
    EXPECT_NEAR(s.largest_overlap, packing.largest_overlap, 1e-12);

    double contacts = 0, rattlers = 0;
    for (const int c : s.contacts) {
        contacts += c;
        rattlers += c < 4 ? 1 : 0;
    }
    const auto n = static_cast<double>(s.contacts.size());
    EXPECT_NEAR(contacts / n, 6.081, 0.12);                       // 6.111, 6.049, 6.083
    EXPECT_NEAR(rattlers / n, 0.0221, 0.009);                     // 0.0208, 0.0247, 0.0209
    EXPECT_NEAR(s.per_sphere(s.within_2_percent), 6.728, 0.08);   // 6.751, 6.711, 6.722
    EXPECT_NEAR(s.per_sphere(s.within_10_percent), 8.452, 0.08);  // 8.470, 8.431, 8.453

    // The first minimum and the split second peak of a jammed packing.
    EXPECT_NEAR(s.g(1.35, 20), 0.558, 0.03);  // 0.565, 0.553, 0.557
    EXPECT_NEAR(s.g(1.70, 20), 1.308, 0.03);  // 1.311, 1.311, 1.301: near sqrt 3
    EXPECT_NEAR(s.g(1.85, 20), 1.281, 0.03);  // 1.280, 1.288, 1.276: between
    EXPECT_NEAR(s.g(1.95, 20), 1.609, 0.03);  // 1.610, 1.610, 1.607: near 2
    EXPECT_NEAR(s.g(2.00, 20), 0.951, 0.05);  // 0.939, 0.967, 0.948: the step after it
}

TEST(PackingStatistics, FillTheCubeEvenly) {
    // Spheres per octant: far below Poisson scatter (34), since density fluctuations of a packing are suppressed.
    const Packing packing = random_close_packing({20, 0.62, 2, 2e-5});
    std::vector<int> octants(8, 0);
    for (const auto& x : packing.positions)
        ++octants[(x[0] < 10 ? 0U : 1U) + (x[1] < 10 ? 0U : 2U) + (x[2] < 10 ? 0U : 4U)];
    for (const int count : octants) EXPECT_NEAR(count, 9473 / 8.0, 34);
}

}  // namespace grainsweep::tests::packing_statistics_test
