#include "stats/least_squares.hpp"

#include "stats/random.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>

namespace grainsweep::tests::stats_least_squares_test {

using stats::least_squares;

/// 1, a column of a large mean and a small scatter, and four columns in [0, 1).
Eigen::MatrixXd columns(double mean) {
    stats::Generator draws(1);
    Eigen::MatrixXd a(50, 6);
    for (Eigen::Index i = 0; i < a.rows(); ++i) {
        a(i, 0) = 1;
        a(i, 1) = mean + draws.uniform();
        for (Eigen::Index j = 2; j < a.cols(); ++j) a(i, j) = draws.uniform();
    }
    return a;
}

Eigen::VectorXd scattered(Eigen::Index rows) {
    stats::Generator draws(2);
    Eigen::VectorXd y(rows);
    for (double& value : y) value = draws.uniform();
    return y;
}

TEST(StatsLeastSquares, FindsTheCoefficients) {
    Eigen::VectorXd b(6);
    b << 3, -2, 0.5, 1, 0, -7;
    EXPECT_LT((least_squares(columns(0), columns(0) * b) - b).norm(), 1e-13);
    // The mean of a column is 1e6 times its scatter: so much more of the rounding reaches the coefficients.
    EXPECT_LT((least_squares(columns(1e6), columns(1e6) * b) - b).tail(5).norm(), 1e-8);
}

TEST(StatsLeastSquares, LeavesNothingThatTheColumnsCouldExplain) {
    for (const double mean : {0.0, 1e3, 1e6}) {
        const Eigen::MatrixXd a = columns(mean);
        const Eigen::VectorXd y = scattered(a.rows()), left = y - a * least_squares(a, y);
        for (Eigen::Index j = 0; j < a.cols(); ++j)
            EXPECT_NEAR(a.col(j).dot(left), 0, 1e-10 * a.col(j).norm() * y.norm()) << mean << " " << j;
        EXPECT_GT(left.norm(), 0.1 * y.norm());
    }
}

TEST(StatsLeastSquares, LeavesOutColumnsThatOthersGive) {
    const Eigen::MatrixXd a = columns(10);
    const Eigen::VectorXd y = scattered(a.rows()), whole = a * least_squares(a, y);
    Eigen::MatrixXd more(a.rows(), a.cols() + 3);
    more << a.leftCols(3), Eigen::VectorXd::Zero(a.rows()), Eigen::VectorXd::Constant(a.rows(), 5), a.rightCols(3),
        a.col(1) - 2 * a.col(2);
    const Eigen::VectorXd b = least_squares(more, y);
    EXPECT_LT((more * b - whole).norm(), 1e-11);
    EXPECT_EQ((b.array() == 0).count(), 3);
}

TEST(StatsLeastSquares, NoColumnsExplainNothing) {
    EXPECT_EQ(least_squares(Eigen::MatrixXd::Zero(5, 2), Eigen::VectorXd::Ones(5)).norm(), 0);
    EXPECT_EQ(least_squares(Eigen::MatrixXd(5, 0), Eigen::VectorXd::Ones(5)).size(), 0);
}

}  // namespace grainsweep::tests::stats_least_squares_test
