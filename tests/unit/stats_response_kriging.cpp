// The algebra of the response model against plain dense formulae, written out here a second time.
#include "stats/random.hpp"
#include "stats/response/fit.hpp"
#include "stats/response/kriging.hpp"
#include "stats/response/likelihood.hpp"
#include "stats/response/local_noise.hpp"
#include "stats/response/triangular.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <vector>

namespace grainsweep::tests::stats_response_kriging_test {

using namespace stats;
using namespace stats::response;

/// n uniform points and a smooth response with some scatter.
struct Sample {
    Eigen::MatrixXd x;
    Eigen::VectorXd z;
};

Sample sample(Eigen::Index n, Eigen::Index d, std::uint64_t seed) {
    Sample s{Eigen::MatrixXd(n, d), Eigen::VectorXd(n)};
    const Stream stream(seed, 7);
    for (Eigen::Index i = 0; i < n; ++i) {
        double y = 0.3 * stream.uniform(static_cast<std::uint64_t>(1000000 + i));
        for (Eigen::Index j = 0; j < d; ++j) {
            s.x(i, j) = stream.uniform(static_cast<std::uint64_t>(i * d + j));
            y += std::sin(3 * s.x(i, j) * static_cast<double>(j + 1)) / static_cast<double>(j + 1);
        }
        s.z(i) = y;
    }
    s.z.array() -= s.z.mean();
    s.z /= std::sqrt(s.z.squaredNorm() / static_cast<double>(n));
    return s;
}

Hyperparameters some_hyperparameters(Eigen::Index d) {
    Hyperparameters h{Eigen::VectorXd::LinSpaced(d, -0.7, 0.2), 0.4, std::log(0.03), Eigen::MatrixXd::Identity(d, d)};
    for (Eigen::Index j = 0; j < d; ++j)
        for (Eigen::Index k = j + 1; k < d; ++k) h.shear(j, k) = 0.3 - 0.2 * static_cast<double>(k);
    return h;
}

/// s^2 C by the definition of the kernel.
double plain_kernel(const Hyperparameters& h, const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    double r2 = 0;
    for (Eigen::Index j = 0; j < a.size(); ++j) {
        double moved = 0;
        for (Eigen::Index k = j; k < a.size(); ++k) moved += h.shear(j, k) * (a(k) - b(k));
        r2 += std::pow(moved / std::exp(h.log_length(j)), 2);
    }
    const double r = std::sqrt(5 * r2);
    return std::exp(h.log_signal) * (1 + r + r * r / 3) * std::exp(-r);
}

/// [K 1; 1^T 0]
Eigen::MatrixXd plain_system(const Hyperparameters& h, const Eigen::MatrixXd& x) {
    const Eigen::Index n = x.rows();
    Eigen::MatrixXd system = Eigen::MatrixXd::Ones(n + 1, n + 1);
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j < n; ++j)
            system(i, j) = plain_kernel(h, x.row(i), x.row(j)) + (i == j ? std::exp(h.log_noise) : 0);
    system(n, n) = 0;
    return system;
}

struct Plain {
    double mean, variance;
};

Plain plain_prediction(const Hyperparameters& h, const Sample& s, const Eigen::VectorXd& at) {
    const Eigen::Index n = s.x.rows();
    Eigen::VectorXd right = Eigen::VectorXd::Ones(n + 1), z = Eigen::VectorXd::Zero(n + 1);
    for (Eigen::Index i = 0; i < n; ++i) right(i) = plain_kernel(h, s.x.row(i), at);
    z.head(n) = s.z;
    const Eigen::VectorXd solved = plain_system(h, s.x).fullPivLu().solve(right);
    return {solved.dot(z), std::exp(h.log_signal) - solved.dot(right)};
}

Sample without(const Sample& s, const std::vector<Eigen::Index>& left_out) {
    std::vector<Eigen::Index> kept;
    for (Eigen::Index i = 0; i < s.x.rows(); ++i)
        if (std::ranges::find(left_out, i) == left_out.end()) kept.push_back(i);
    return {s.x(kept, Eigen::all), s.z(kept)};
}

TEST(Kriging, PredictsAsTheDenseSystemSays) {
    const Sample s = sample(23, 3, 1);
    const Hyperparameters h = some_hyperparameters(3);
    const Kriging model = solve_kriging(h, s.x, s.z).value();
    const Sample at = sample(300, 3, 2);  // more than one block
    const auto p = predict(model, mapped(h, at.x));
    const auto means = predict_means(model, mapped(h, at.x));
    for (Eigen::Index i = 0; i < at.x.rows(); ++i) {
        const Plain plain = plain_prediction(h, s, at.x.row(i));
        EXPECT_NEAR(p.mean(i), plain.mean, 1e-10);
        EXPECT_NEAR(p.variance(i), plain.variance, 1e-10);
        EXPECT_NEAR(means(i), plain.mean, 1e-10);
    }
}

TEST(Kriging, LeavingOutInClosedFormIsLeavingOut) {
    const Sample s = sample(23, 2, 3);
    const Hyperparameters h = some_hyperparameters(2);
    const LeftOut out = leave_one_out(solve_kriging(h, s.x, s.z).value());
    for (Eigen::Index i = 0; i < s.x.rows(); ++i) {
        const Plain plain = plain_prediction(h, without(s, {i}), s.x.row(i));
        EXPECT_NEAR(out.residual(i), s.z(i) - plain.mean, 1e-10);
        EXPECT_NEAR(out.variance(i), plain.variance + std::exp(h.log_noise), 1e-10);
    }
}

TEST(Kriging, FoldsLeftOutAreLeftOut) {
    const Sample s = sample(31, 2, 12), at = sample(5, 2, 13);
    const Hyperparameters h = some_hyperparameters(2);
    const Kriging model = solve_kriging(h, s.x, s.z).value();
    const std::vector<std::vector<Eigen::Index>> folds{{0, 3, 6, 9, 30}, {1, 2}, {}};
    const Eigen::MatrixXd means = leave_folds_out(model, inverse_of(model), folds).predict(model, mapped(h, at.x));
    for (std::size_t f = 0; f < folds.size(); ++f)
        for (Eigen::Index i = 0; i < at.x.rows(); ++i)
            EXPECT_NEAR(means(i, static_cast<Eigen::Index>(f)),
                        plain_prediction(h, without(s, folds[f]), at.x.row(i)).mean, 1e-10);
}

TEST(Kriging, CasesAddedAreAsIfTheyHadBeenThere) {
    const Sample all = sample(40, 3, 4);
    const Hyperparameters h = some_hyperparameters(3);
    const Kriging whole = solve_kriging(h, all.x, all.z).value();
    const Kriging part = solve_kriging(h, all.x.topRows(33), all.z.head(33)).value();
    const Kriging grown = extend_kriging(part, all.x.bottomRows(7), all.z.tail(7)).value();
    EXPECT_NEAR(grown.mean, whole.mean, 1e-11);
    EXPECT_LT((grown.weights - whole.weights).cwiseAbs().maxCoeff(), 1e-9);
    const Eigen::MatrixXd lower = grown.factor.triangularView<Eigen::Lower>();
    const Eigen::MatrixXd expected = whole.factor.triangularView<Eigen::Lower>();
    EXPECT_LT((lower - expected).cwiseAbs().maxCoeff(), 1e-11);
}

TEST(Kriging, BlockedInversesAreInverses) {
    const Sample s = sample(300, 3, 5);
    const Hyperparameters h = some_hyperparameters(3);
    const Kriging model = solve_kriging(h, s.x, s.z).value();
    Eigen::MatrixXd inverse = model.factor;
    inverse.triangularView<Eigen::StrictlyUpper>().setConstant(99);  // must neither be read nor written
    invert_lower(inverse);
    EXPECT_EQ(inverse(0, 299), 99);
    const Eigen::MatrixXd k = plain_system(h, s.x).topLeftCorner(300, 300);
    EXPECT_LT((k * gram_of_lower(inverse) - Eigen::MatrixXd::Identity(300, 300)).cwiseAbs().maxCoeff(), 1e-10);
    EXPECT_LT((gram_diagonal_of_lower(inverse) - gram_of_lower(inverse).diagonal()).cwiseAbs().maxCoeff(), 1e-11);
}

TEST(Likelihood, IsTheGaussianDensityTimesThePriors) {
    const Sample s = sample(18, 2, 6);
    const Hyperparameters h = some_hyperparameters(2);
    const Likelihood likelihood(s.x, s.z, true);
    const Eigen::MatrixXd k = plain_system(h, s.x).topLeftCorner(18, 18);
    const Eigen::MatrixXd inverse = k.inverse();
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(18);
    const double mean = ones.dot(inverse * s.z) / ones.dot(inverse * ones);
    const Eigen::VectorXd r = s.z.array() - mean;
    double expected = -0.5 * r.dot(inverse * r) - 0.5 * std::log(k.determinant()) - 9 * std::log(2 * M_PI);
    for (Eigen::Index j = 0; j < 2; ++j) expected -= 0.5 * std::pow(h.log_length(j) / 1.5, 2);
    expected -= 0.5 * std::pow((h.log_noise - std::log(0.02)) / 2, 2) + 0.5 * std::pow(h.shear(0, 1), 2);
    EXPECT_NEAR(likelihood.value(likelihood.parameters(h)), expected, 1e-9);
}

TEST(Likelihood, GradientIsThatOfDifferences) {
    for (const bool map : {false, true}) {
        const Sample s = sample(90, 3, 8);
        const Likelihood likelihood(s.x, s.z, map);
        const Eigen::VectorXd at = likelihood.parameters(some_hyperparameters(3));
        Eigen::VectorXd gradient;
        EXPECT_NEAR(likelihood.value(at, gradient), likelihood.value(at), 1e-9);
        ASSERT_EQ(gradient.size(), map ? 8 : 5);
        for (Eigen::Index j = 0; j < at.size(); ++j) {
            Eigen::VectorXd up = at, down = at;
            up(j) += 1e-5;
            down(j) -= 1e-5;
            const double slope = (likelihood.value(up) - likelihood.value(down)) / 2e-5;
            EXPECT_NEAR(gradient(j), slope, 1e-5 * std::max(1.0, std::abs(slope))) << j;
        }
    }
}

TEST(Likelihood, TheSearchEndsWhereTheGradientVanishes) {
    const Sample s = sample(120, 2, 9);
    const Hyperparameters h = fit_lengths(s.x, s.z, {}).value();
    const Likelihood likelihood(s.x, s.z, false);
    Eigen::VectorXd gradient;
    likelihood.value(likelihood.parameters(h), gradient);
    EXPECT_LT(gradient.cwiseAbs().maxCoeff(), 0.2);
}

TEST(LocalNoise, NeighboursDecideTheFactor) {
    // 36 cases on a line: k = 4. Those to the right scatter three times as much as predicted.
    LocalNoise noise{Eigen::MatrixXd(36, 1), Eigen::VectorXd(36)};
    for (Eigen::Index i = 0; i < 36; ++i) {
        noise.points(i, 0) = static_cast<double>(i);
        noise.squared_scores(i) = i < 18 ? 1 : 9;
    }
    EXPECT_EQ(noise.neighbours(), 4);
    Eigen::MatrixXd at(2, 1);
    at << 3.2, 30.2;
    const Eigen::VectorXd factors = noise.factors(at);
    EXPECT_DOUBLE_EQ(factors(0), 1);
    EXPECT_DOUBLE_EQ(factors(1), (4 * 9 + 4) / 8.0);
    noise.squared_scores(10) = 1e6;  // a case does not widen its own interval
    EXPECT_DOUBLE_EQ(noise.factors(noise.points, true)(10), 1);
}

TEST(SpaceFilling, ChoosesFarFromWhatIsChosen) {
    Eigen::MatrixXd points(6, 1);
    points << 0.0, 0.45, 0.5, 0.55, 1.0, 0.5;
    EXPECT_EQ(space_filling_choice(points, 3), (std::vector<Eigen::Index>{0, 2, 4}));
    EXPECT_EQ(space_filling_choice(points, 9).size(), 6U);
    EXPECT_EQ(spread_choice(1000, 10), spread_choice(1000, 10));
}

}  // namespace grainsweep::tests::stats_response_kriging_test
