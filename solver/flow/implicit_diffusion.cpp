#include "solver/flow/implicit_diffusion.hpp"

#include "solver/flow/dense_product.hpp"
#include "solver/flow/second_difference.hpp"
#include "solver/flow/vector_clones.hpp"

#include <Eigen/LU>

#include <algorithm>

namespace grainsweep::flow {
namespace {

// One row of the forward elimination: r = (r + low * previous) / pivot.
GRAINSWEEP_VECTOR_CLONES
void eliminate(double* __restrict row, const double* __restrict previous, int n, double low, double inverse_pivot) {
    for (int i = 0; i < n; ++i) row[i] = (row[i] + low * previous[i]) * inverse_pivot;
}

// One row of the back substitution: r = r + (high / pivot) * next.
GRAINSWEEP_VECTOR_CLONES
void substitute(double* __restrict row, const double* __restrict next, int n, double high_over_pivot) {
    for (int i = 0; i < n; ++i) row[i] += high_over_pivot * next[i];
}

}  // namespace

ImplicitDiffusion::ImplicitDiffusion(const Grid& grid, const Edges& edges, double a)
    : n_{grid.cells(0), grid.cells(1), grid.cells(2)} {
    for (int d = 0; d < 3; ++d) {
        const auto at = static_cast<std::size_t>(d);
        const Edge& edge = edges[at];
        by_matrix_[at] = d == 0 || edge.periodic;
        const int n = n_[at];
        const Eigen::MatrixXd factor = Eigen::MatrixXd::Identity(n, n) - a * second_difference_matrix(grid[d], edge);
        if (by_matrix_[at]) {
            const Eigen::MatrixXd inverse = factor.inverse();
            for (int r = 0; r < n; ++r)
                for (int c = 0; c < n; ++c) inverse_[at].push_back(d == 0 ? inverse(c, r) : inverse(r, c));
            continue;
        }
        Sweep& sweep = sweeps_[at];
        sweep.first = first_unknown(edge);
        const auto size = static_cast<std::size_t>(n) + 2;
        sweep.low.assign(size, 0);
        sweep.inverse_pivot.assign(size, 1);
        sweep.high_over_pivot.assign(size, 0);
        for (int i = sweep.first; i <= n; ++i) {
            const auto m = static_cast<std::size_t>(i);
            const double low = i > sweep.first ? -factor(i - 1, i - 2) : 0;
            const double high = i < n ? -factor(i - 1, i) : 0;
            sweep.low[m] = low;
            sweep.inverse_pivot[m] = 1 / (factor(i - 1, i - 1) - low * sweep.high_over_pivot[m - 1]);
            sweep.high_over_pivot[m] = high * sweep.inverse_pivot[m];
        }
    }
    scratch_.resize(static_cast<std::size_t>(n_[0]) * static_cast<std::size_t>(std::max(n_[1], n_[2])));
}

void ImplicitDiffusion::sweep_y(Field& field) const {
    const Sweep& s = sweeps_[1];
    for (int k = 1; k <= n_[2]; ++k) {
        for (int j = s.first; j <= n_[1]; ++j) {
            const auto m = static_cast<std::size_t>(j);
            double* const row = field.data() + field.index(1, j, k);
            eliminate(row, row - field.stride(1), n_[0], s.low[m], s.inverse_pivot[m]);
        }
        for (int j = n_[1] - 1; j >= s.first; --j) {
            double* const row = field.data() + field.index(1, j, k);
            substitute(row, row + field.stride(1), n_[0], s.high_over_pivot[static_cast<std::size_t>(j)]);
        }
    }
}

void ImplicitDiffusion::sweep_z(Field& field) const {
    const Sweep& s = sweeps_[2];
    for (int j = 1; j <= n_[1]; ++j) {
        for (int k = s.first; k <= n_[2]; ++k) {
            const auto m = static_cast<std::size_t>(k);
            double* const row = field.data() + field.index(1, j, k);
            eliminate(row, row - field.stride(2), n_[0], s.low[m], s.inverse_pivot[m]);
        }
        for (int k = n_[2] - 1; k >= s.first; --k) {
            double* const row = field.data() + field.index(1, j, k);
            substitute(row, row + field.stride(2), n_[0], s.high_over_pivot[static_cast<std::size_t>(k)]);
        }
    }
}

void ImplicitDiffusion::multiply(Field& field, int direction) {
    const auto along = static_cast<std::size_t>(direction);
    const int across = direction == 1 ? 2 : 1;  // the axis of the outer loop
    const int n = n_[along];
    for (int q = 1; q <= n_[static_cast<std::size_t>(across)]; ++q) {
        double* const lines = field.data() + 1 + field.stride(direction) + q * field.stride(across);
        dense_product(n, n_[0], n, inverse_[along].data(), n, lines, field.stride(direction), scratch_.data(), n_[0]);
        for (int m = 0; m < n; ++m)
            std::copy_n(scratch_.data() + static_cast<std::ptrdiff_t>(m) * n_[0], n_[0],
                        lines + m * field.stride(direction));
    }
}

void ImplicitDiffusion::solve(Field& right, Field& solution) {
    if (by_matrix_[1])
        multiply(right, 1);
    else
        sweep_y(right);
    if (by_matrix_[2])
        multiply(right, 2);
    else
        sweep_z(right);
    for (int k = 1; k <= n_[2]; ++k)
        dense_product(n_[1], n_[0], n_[0], right.data() + right.index(1, 1, k), right.stride(1), inverse_[0].data(),
                      n_[0], solution.data() + solution.index(1, 1, k), solution.stride(1));
}

}  // namespace grainsweep::flow
