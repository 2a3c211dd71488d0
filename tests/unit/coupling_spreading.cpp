// The kernel of the deposits: what it keeps, how wide it is, and that its width is that of no grid.
#include "solver/coupling/interpolation.hpp"
#include "solver/coupling/spreading.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace grainsweep::tests::coupling_spreading_test {

using namespace coupling;
using flow::Axis;
using flow::Grid;

struct Line {
    Axis axis;
    bool periodic;
};
const std::vector<Line>& lines() {
    static const std::vector<Line> all = {{Axis::uniform(12, -0.5, 0.5), false},
                                          {Axis::uniform(12, -0.5, 0.5), true},
                                          {Axis::clustered(12, -0.5, 0.5, 1.8), false},
                                          {Axis::clustered(3, 0, 2, 1), false},
                                          {Axis::uniform(1, 0, 1), false}};
    return all;
}

// A uniform density stays uniform, a deposit keeps its sum, nothing becomes negative, and the kernel from deposits to
// densities is symmetric.
TEST(Spreading, KeepsTotalsAndUniformDensities) {
    for (const Line& line : lines())
        for (const Nodes nodes : {Nodes::cells, Nodes::faces})
            for (const double width : {0.0, 0.03, 0.2, 1.0}) {
                const Eigen::MatrixXd kernel = spreading_matrix(line.axis, line.periodic, nodes, width);
                const Eigen::VectorXd lengths = node_lengths(line.axis, line.periodic, nodes);
                const Eigen::VectorXd ones = Eigen::VectorXd::Ones(kernel.rows());
                EXPECT_LT((kernel * ones - ones).cwiseAbs().maxCoeff(), 1e-13);
                const Eigen::VectorXd totals = kernel.transpose() * lengths;
                EXPECT_LT((totals - lengths).cwiseAbs().maxCoeff(), 1e-13);
                EXPECT_GT(kernel.minCoeff(), -1e-15);
                const Eigen::MatrixXd symmetric = lengths.asDiagonal() * kernel;
                EXPECT_LT((symmetric - symmetric.transpose()).cwiseAbs().maxCoeff(), 1e-14);
            }
}

// What linear weights leave of a uniform density, levelled: the widths. Sums stay, nothing becomes negative.
TEST(Levelling, EvensWhatAUniformDensityDeposits) {
    for (const Line& line : lines()) {
        const int n = line.axis.cells();
        Eigen::VectorXd deposit = Eigen::VectorXd::Zero(n);
        const int places = 20000 * n;
        for (int p = 0; p < places; ++p) {
            const double x = line.axis.low() + line.axis.length() * (p + 0.5) / places;
            const auto w = Trilinear::across(line.axis, line.periodic, x, Trilinear::find(line.axis, x));
            for (int a = 0; a < 2; ++a) {
                const int cell = line.periodic ? (w.first + a - 1 + n) % n : std::clamp(w.first + a - 1, 0, n - 1);
                deposit(cell) += w.weight[static_cast<std::size_t>(a)] * line.axis.length() / places;
            }
        }
        const Eigen::MatrixXd level = levelling_matrix(line.axis, line.periodic, Nodes::cells);
        const Eigen::VectorXd widths = node_lengths(line.axis, line.periodic, Nodes::cells);
        EXPECT_LT((level * deposit - widths).cwiseAbs().maxCoeff(), 1e-6);
        EXPECT_LT((level.transpose() * Eigen::VectorXd::Ones(n) - Eigen::VectorXd::Ones(n)).cwiseAbs().maxCoeff(),
                  1e-14);
        EXPECT_GE(level.minCoeff(), 0);
        if (!line.axis.is_uniform() && n > 3) {
            EXPECT_GT((deposit - widths).cwiseQuotient(widths).cwiseAbs().maxCoeff(), 0.05) << "there was work to do";
        }
    }
}

// The divergence of a spread flux is the spread divergence: what lets a volume fraction and its flux agree.
TEST(Spreading, CommutesWithTheDivergence) {
    for (const Line& line : lines())
        for (const double width : {0.0, 0.1, 0.4}) {
            const int n = line.axis.cells();
            const auto of_cells = spreading_matrix(line.axis, line.periodic, Nodes::cells, width);
            const auto of_flux = spreading_matrix(line.axis, line.periodic, Nodes::flux, width);
            Eigen::VectorXd flux(n);
            for (int f = 1; f <= n; ++f) flux(f - 1) = std::sin(1.7 * f) + 0.3 * f;
            if (!line.periodic) flux(0) = 0;
            const auto divergence = [&](const Eigen::VectorXd& through) {
                Eigen::VectorXd net(n);
                for (int i = 1; i <= n; ++i) {
                    const double above = i < n ? through(i) : line.periodic ? through(0) : 0;
                    net(i - 1) = (above - through(i - 1)) / line.axis.width(i);
                }
                return net;
            };
            const Eigen::VectorXd spread = of_flux * flux;
            if (!line.periodic) {
                EXPECT_EQ(spread(0), 0);
            }
            EXPECT_LT((divergence(spread) - of_cells * divergence(flux)).cwiseAbs().maxCoeff(), 1e-10);
            // Levelling works on amounts, not on densities.
            const Eigen::VectorXd widths = node_lengths(line.axis, line.periodic, Nodes::cells);
            const Eigen::VectorXd levelled = levelling_matrix(line.axis, line.periodic, Nodes::flux) * flux;
            if (!line.periodic) {
                EXPECT_EQ(levelled(0), 0);
            }
            const Eigen::VectorXd left =
                levelling_matrix(line.axis, line.periodic, Nodes::cells) * divergence(flux).cwiseProduct(widths);
            EXPECT_LT((divergence(levelled).cwiseProduct(widths) - left).cwiseAbs().maxCoeff(), 1e-13);
        }
}

// Linear deposit and kernel together have the variance w^2 wherever cells are narrower than 2.4 w, on the mean over
// where between its nodes a particle stands; and the particle stays where it is.
template <class Deposit, class Node>
void expect_width(Nodes nodes, Deposit deposit_at, Node position) {
    const double width = 0.05;
    for (const Axis& axis : {Axis::uniform(20, -0.5, 0.5), Axis::clustered(28, -0.5, 0.5, 1.5),
                             Axis::clustered(40, -0.5, 0.5, 2.2), Axis::uniform(10, -0.5, 0.5)}) {
        const Eigen::MatrixXd kernel = spreading_matrix(axis, false, nodes, width);
        const Eigen::VectorXd lengths = node_lengths(axis, false, nodes);
        const int middle = axis.cells() / 2;
        const double start = position(axis, middle);
        const int places = 200;
        double variance = 0;
        for (int p = 0; p < places; ++p) {
            const double x = start + (position(axis, middle + 1) - start) * (p + 0.5) / places;
            const AxisWeights<2> deposit = deposit_at(axis, x);
            double mean = 0;
            for (int i = nodes == Nodes::faces ? 2 : 1; i <= axis.cells(); ++i) {
                double share = 0;  // deposit -> density -> deposit
                for (int a = 0; a < 2; ++a)
                    share += deposit.weight[static_cast<std::size_t>(a)] * kernel(i - 1, deposit.first + a - 1) *
                             lengths(i - 1) / lengths(deposit.first + a - 1);
                mean += share * position(axis, i);
                variance += share * (position(axis, i) - x) * (position(axis, i) - x) / places;
            }
            EXPECT_NEAR(mean, x, 0.01 * width);
        }
        EXPECT_NEAR(std::sqrt(variance), width, 0.01 * width) << axis.cells();
    }
}

TEST(Spreading, HasTheWidthItIsAskedFor) {
    expect_width(
        Nodes::cells,
        [](const Axis& axis, double x) { return Trilinear::across(axis, false, x, Trilinear::find(axis, x)); },
        [](const Axis& axis, int i) { return axis.centre(i); });
    expect_width(
        Nodes::faces,
        [](const Axis& axis, double x) { return Trilinear::own(axis, false, x, Trilinear::find(axis, x)); },
        [](const Axis& axis, int i) { return axis.face(i); });
}

// In three dimensions the density far and near is that of a Gaussian, to second order in the cell.
TEST(Spreading, BecomesTheGaussian) {
    const double width = 0.08;
    const auto error = [&](int n) {
        const Axis axis = Axis::clustered(n, -0.5, 0.5, 1.2);
        const Grid grid{{axis, axis, axis}};
        const std::array<bool, 3> closed{};
        const Spreading spreading(grid, closed, {Nodes::cells, Nodes::cells, Nodes::cells}, width);
        grainsweep::flow::Field field(grid);
        const Vec3 x{0.05, -0.02, 0.08};
        std::array<AxisWeights<2>, 3> w;
        for (int d = 0; d < 3; ++d) {
            const double along = x[static_cast<std::size_t>(d)];
            w[static_cast<std::size_t>(d)] = Trilinear::across(axis, false, along, Trilinear::find(axis, along));
        }
        for (int c = 0; c < 2; ++c)
            for (int b = 0; b < 2; ++b)
                for (int a = 0; a < 2; ++a)
                    field(w[0].first + a, w[1].first + b, w[2].first + c) = w[0].weight[static_cast<std::size_t>(a)] *
                                                                            w[1].weight[static_cast<std::size_t>(b)] *
                                                                            w[2].weight[static_cast<std::size_t>(c)];
        Spreading::Scratch scratch{field, field};
        spreading.densities(field, scratch);
        double worst = 0;
        const double peak = std::pow(2 * std::numbers::pi * width * width, -1.5);
        for (int k = 1; k <= n; ++k)
            for (int j = 1; j <= n; ++j)
                for (int i = 1; i <= n; ++i) {
                    const double r2 = std::pow(axis.centre(i) - x[0], 2) + std::pow(axis.centre(j) - x[1], 2) +
                                      std::pow(axis.centre(k) - x[2], 2);
                    worst = std::max(worst, std::abs(field(i, j, k) / peak - std::exp(-r2 / (2 * width * width))));
                }
        return worst;
    };
    EXPECT_LT(error(28), 0.22);  // cells of two thirds of the width in the middle
    EXPECT_LT(error(56), 0.3 * error(28));
}

// Against a wall nothing is lost: the image of the deposit stands behind it.
TEST(Spreading, ReflectsAtWalls) {
    const Axis axis = Axis::uniform(200, 0, 1);
    const Eigen::MatrixXd kernel = spreading_matrix(axis, false, Nodes::cells, 0.05);
    for (const int at : {1, 5, 20})
        for (const int i : {1, 3, 10, 30}) {
            const auto gauss = [&](double x) { return std::exp(-x * x / 0.005) / std::sqrt(0.005 * std::numbers::pi); };
            const double exact = gauss(axis.centre(i) - axis.centre(at)) + gauss(axis.centre(i) + axis.centre(at));
            EXPECT_NEAR(kernel(i - 1, at - 1) / axis.width(at), exact, 0.05);  // of a peak of 8 to 16
        }
}

}  // namespace grainsweep::tests::coupling_spreading_test
