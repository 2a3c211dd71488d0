#include "stats/calibration.hpp"
#include "stats/posterior.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace grainsweep::tests::stats_calibration_test {

using namespace stats;

TEST(Calibration, ImplausibilityIsTheDistanceInStandardDeviations) {
    const std::vector<Target> targets{{.value = 10, .measured_error = 1, .discrepancy = 2, .replicates = 4}};
    const std::vector<std::vector<Prediction>> predictions{{{4, 2, 2}, {10, 1, 1}}};
    const auto i = implausibilities(targets, predictions);
    EXPECT_NEAR(i[0][0], 6 / std::sqrt(4 + 1 + 4 + 4.0 / 4), 1e-15);
    EXPECT_EQ(i[0][1], 0);
    const auto student = implausibilities(
        targets, std::vector<std::vector<Prediction>>{{{.mean = 4, .mean_error = 2, .scatter = 2, .freedom = 8}}});
    EXPECT_NEAR(student[0][0], 6 / std::sqrt(1 + 4 + (4 + 4.0 / 4) * 8 / 6), 1e-15) << "variance of Student's t";
    const std::vector<std::vector<double>> five(5, {4.0}), six{{9.0}, {1.0}, {2.0}, {0.5}, {0.1}, {0.2}};
    EXPECT_EQ(deciding_implausibility(five)[0], 4);
    EXPECT_EQ(deciding_implausibility(six)[0], 2);
    EXPECT_THROW(
        (void)implausibilities(std::vector<Target>{{.value = 1}}, std::vector<std::vector<Prediction>>{{{1, 0, 0}}}),
        std::invalid_argument);
}

TEST(Calibration, LikelihoodIsTheNormalDensity) {
    const std::vector<Target> targets{{.value = 1, .measured_error = 0.5, .discrepancy = 0.2, .replicates = 2},
                                      {.value = 3, .measured_error = 0.3, .discrepancy = 0.1, .replicates = 0}};
    const std::vector<std::vector<Prediction>> predictions{{{0.5, 0.1, 0.4}}, {{3.3, 0.2, 0.7}}};
    Eigen::Matrix2d c;
    c << 0.29, 0.05, 0.05, 0.10;
    Eigen::Matrix2d v = c;
    v(0, 0) += 0.01 + 0.16 / 2;
    v(1, 1) += 0.04;  // no replicates: its scatter is in its error
    const Eigen::Vector2d r(0.5, -0.3);
    const double expected = -0.5 * r.dot(v.inverse() * r) - 0.5 * std::log(v.determinant());
    EXPECT_NEAR(log_likelihood(targets, predictions, std::vector{0.29, 0.05, 0.05, 0.10})[0], expected, 1e-12);
    const Eigen::Matrix2d diagonal = v.diagonal().asDiagonal();
    const double alone = -0.5 * r.dot(diagonal.inverse() * r) - 0.5 * std::log(diagonal.determinant());
    EXPECT_NEAR(log_likelihood(targets, predictions)[0], alone, 1e-12);
}

TEST(Calibration, TargetsOutOfReachAreNoticed) {
    const Target target{.value = 12, .measured_error = 0.3, .discrepancy = 0.4};
    EXPECT_NEAR(beyond_what_was_reached(target, std::vector{1.0, 10.0, std::nan("")}), 2 / 0.5, 1e-12);
    EXPECT_EQ(beyond_what_was_reached(target, std::vector{1.0, 13.0}), 0);
}

TEST(Posterior, LinearGaussianCaseIsItsClosedForm) {
    // z = A x + e, e ~ N(0, S), a flat prior wide beside it: x ~ N(x0, (A^T S^-1 A)^-1).
    Eigen::Matrix2d a;
    a << 1, 2, 3, -1;
    const Eigen::Vector2d truth(0.45, 0.55), errors(0.05, 0.08);
    const Eigen::Vector2d z = a * truth;
    const LogDensity density = [&](Rows points) {
        std::vector<double> values;
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Eigen::Vector2d x(points.row(i)[0], points.row(i)[1]);
            values.push_back(-0.5 * ((z - a * x).array() / errors.array()).square().sum());
        }
        return values;
    };
    const Eigen::Matrix2d covariance = (a.transpose() * errors.cwiseAbs2().cwiseInverse().asDiagonal() * a).inverse();
    const auto sample = sample_posterior(density, {std::vector{0.5, 0.5}, 2}, {.walkers = 40, .steps = 4000});
    EXPECT_GT(sample.effective, 3000);
    EXPECT_LT(sample.scale_reduction, 1.05);
    EXPECT_GT(sample.acceptance, 0.4);
    const auto shape = posterior_shape(sample.rows());
    // Four standard errors of a mean and of a standard deviation.
    for (Eigen::Index j = 0; j < 2; ++j) {
        const double sd = std::sqrt(covariance(j, j)), e = 4 / std::sqrt(sample.effective);
        EXPECT_NEAR(shape.mean[static_cast<std::size_t>(j)], truth(j), e * sd);
        EXPECT_NEAR(shape.sd[static_cast<std::size_t>(j)], sd, e * sd);
    }
    EXPECT_NEAR(shape.correlation[1], covariance(0, 1) / std::sqrt(covariance(0, 0) * covariance(1, 1)), 0.07);
}

TEST(Posterior, ARidgeIsNamedByItsDirection) {
    // Only x1 + x2 is measured: the posterior is a line across the box.
    const LogDensity density = [](Rows points) {
        std::vector<double> values;
        for (std::size_t i = 0; i < points.size(); ++i)
            values.push_back(-0.5 * std::pow((points.row(i)[0] + points.row(i)[1] - 1) / 0.02, 2));
        return values;
    };
    const auto sample = sample_posterior(density, {std::vector{0.5, 0.5}, 2}, {.steps = 3000});
    const auto shape = posterior_shape(sample.rows());
    // Along the line x1 is uniform over [0, 1]: sd sqrt(2)/sqrt(12); across it 0.02/sqrt(2).
    EXPECT_NEAR(shape.widths[0], std::sqrt(2.0 / 12), 0.04);
    EXPECT_NEAR(shape.widths[1], 0.02 / std::sqrt(2.0), 0.003);
    EXPECT_NEAR(std::abs(shape.directions[0] + shape.directions[1]), 0, 0.02);
    EXPECT_LT(shape.correlation[1], -0.98);
    for (const double x : sample.points) EXPECT_TRUE(x >= 0 && x <= 1);
}

TEST(Posterior, TheSameSeedGivesTheSameSampleAndNonsenseIsRefused) {
    const LogDensity flat = [](Rows points) { return std::vector<double>(points.size(), 0); };
    const PosteriorSettings few{.walkers = 8, .steps = 50, .settling = 10};
    const std::vector<double> start{0.5};
    EXPECT_EQ(sample_posterior(flat, {start, 1}, few).points, sample_posterior(flat, {start, 1}, few).points);
    const LogDensity never = [](Rows points) {
        return std::vector<double>(points.size(), -std::numeric_limits<double>::infinity());
    };
    EXPECT_THROW((void)sample_posterior(never, {start, 1}, few), std::invalid_argument);
    EXPECT_THROW((void)sample_posterior(flat, {start, 1}, {.walkers = 7}), std::invalid_argument);
}

}  // namespace grainsweep::tests::stats_calibration_test
