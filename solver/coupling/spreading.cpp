#include "solver/coupling/spreading.hpp"

#include <unsupported/Eigen/MatrixFunctions>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace grainsweep::coupling {
namespace {

// Half of the variance that a linear deposit over h lacks.
double lacking(double width, double h) {
    return std::max(0.0, (width * width - h * h / 6) / 2);
}

}  // namespace

Eigen::VectorXd node_lengths(const flow::Axis& axis, bool periodic, Nodes nodes) {
    Eigen::VectorXd lengths = Eigen::VectorXd::Ones(axis.cells());
    for (int i = 1; i <= axis.cells(); ++i) {
        if (nodes == Nodes::cells) lengths(i - 1) = axis.width(i);
        if (nodes == Nodes::faces) lengths(i - 1) = i > 1 || periodic ? axis.spacing(i) : 0;
    }
    return lengths;
}

Eigen::MatrixXd spreading_matrix(const flow::Axis& axis, bool periodic, Nodes nodes, double width) {
    const int n = axis.cells();
    Eigen::MatrixXd rate = Eigen::MatrixXd::Zero(n, n);
    const auto wrapped = [n](int i) { return (i - 1 + n) % n; };  // row or column of index i
    // What diffuses between a and b, out of the first into the second.
    const auto pair = [&](int a, int b, double into_a, double into_b) {
        rate(wrapped(a), wrapped(a)) -= into_a;
        rate(wrapped(a), wrapped(b)) += into_a;
        rate(wrapped(b), wrapped(b)) -= into_b;
        rate(wrapped(b), wrapped(a)) += into_b;
    };
    if (n == 1) return Eigen::MatrixXd::Identity(1, 1);
    if (nodes == Nodes::cells) {
        for (int f = periodic ? 1 : 2; f <= n; ++f) {
            const double h = axis.spacing(f);
            const double s = lacking(width, h) / h;
            const int below = f > 1 ? f - 1 : n;
            pair(below, f, s / axis.width(below), s / axis.width(f));
        }
    } else if (nodes == Nodes::faces) {
        for (int i = periodic ? 1 : 2; i <= (periodic ? n : n - 1); ++i) {
            const double h = axis.width(i);
            const double s = lacking(width, h) / h;
            const int above = i < n ? i + 1 : 1;
            pair(i, above, s / axis.spacing(i), s / axis.spacing(above));
        }
    } else {
        for (int f = periodic ? 1 : 2; f <= n; ++f) {
            const double s = lacking(width, axis.spacing(f)) / axis.spacing(f);
            const auto gradient = [&](int cell, int other) {  // of the flux in a cell beside the face
                rate(wrapped(f), wrapped(f)) -= s / axis.width(cell);
                if (periodic || (other > 1 && other <= n)) rate(wrapped(f), wrapped(other)) += s / axis.width(cell);
            };
            gradient(f, f + 1);
            gradient(f > 1 ? f - 1 : n, f - 1);
        }
    }
    return rate.exp();
}

Eigen::MatrixXd levelling_matrix(const flow::Axis& axis, bool periodic, Nodes nodes) {
    const int n = axis.cells();
    Eigen::MatrixXd level = Eigen::MatrixXd::Identity(n, n);
    if (periodic || nodes == Nodes::faces) return level;  // periodic cells are equal; faces get what they stand for
    const auto too_much_below = [&](int f) { return f > 1 && f <= n ? (axis.width(f) - axis.width(f - 1)) / 4 : 0; };
    for (int f = 2; f <= n; ++f) {
        const double excess = too_much_below(f);
        const int from = excess > 0 ? f - 1 : f;
        const int to = excess > 0 ? f : f - 1;
        const double left = axis.width(from) + too_much_below(from + 1) - too_much_below(from);
        const double share = std::abs(excess) / left;
        if (nodes == Nodes::cells) {
            level(from - 1, from - 1) -= share;
            level(to - 1, from - 1) += share;
        } else {  // through face f, of the change of the cell it comes from
            const double upward = excess > 0 ? share : -share;
            if (from > 1) level(f - 1, from - 1) += upward;
            if (from < n) level(f - 1, from) -= upward;
        }
    }
    return level;
}

Spreading::Spreading(const flow::Grid& grid, const std::array<bool, 3>& periodic, const std::array<Nodes, 3>& nodes,
                     double width, Hats hats)
    : planes_(grid.cells(2)) {
    for (int d = 0; d < 3; ++d) {
        const auto at = static_cast<std::size_t>(d);
        const Eigen::MatrixXd kernel = spreading_matrix(grid[d], periodic[at], nodes[at], width);
        const Eigen::VectorXd lengths = node_lengths(grid[d], periodic[at], nodes[at]);
        const Eigen::VectorXd inverse = (lengths.array() > 0).select(lengths.cwiseInverse(), 0);
        const Eigen::MatrixXd level = hats == Hats::linear ? levelling_matrix(grid[d], periodic[at], nodes[at])
                                                           : Eigen::MatrixXd::Identity(kernel.rows(), kernel.cols());
        const Eigen::MatrixXd inner = kernel * (lengths.array() > 0).cast<double>().matrix().asDiagonal();
        from_densities_[at] = flow::AxisProduct(grid, d, level.transpose() * inner);
        from_deposits_[at] = flow::AxisProduct(grid, d, kernel * inverse.asDiagonal() * level);
    }
}

void Spreading::densities(flow::Field& field, Scratch& scratch, const Slabs& slabs) const {
    apply(from_deposits_, field, scratch, slabs);
}

void Spreading::spread(flow::Field& field, Scratch& scratch, const Slabs& slabs) const {
    apply(from_densities_, field, scratch, slabs);
}

void Spreading::apply(const std::array<flow::AxisProduct, 3>& kernels, flow::Field& field, Scratch& scratch,
                      const Slabs& slabs) const {
    slabs.over(1, planes_, [&](std::ptrdiff_t first, std::ptrdiff_t last) {
        kernels[0].apply(field, scratch[0], static_cast<int>(first), static_cast<int>(last));
        kernels[1].apply(scratch[0], scratch[1], static_cast<int>(first), static_cast<int>(last));
    });
    kernels[2].apply(scratch[1], field, slabs);
}

}  // namespace grainsweep::coupling
