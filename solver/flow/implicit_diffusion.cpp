#include "solver/flow/implicit_diffusion.hpp"

#include "solver/flow/second_difference.hpp"
#include "solver/flow/vector_clones.hpp"

#include <Eigen/LU>

#include <utility>

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
            inverse_[at] = AxisProduct(grid, d, factor.inverse());
            if (d != 0) scratch_ = Field(grid);
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
}

void ImplicitDiffusion::sweep_y(Field& field, int first, int last) const {
    const Sweep& s = sweeps_[1];
    for (int k = first; k <= last; ++k) {
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

void ImplicitDiffusion::sweep_z(Field& field, int first, int last) const {
    const Sweep& s = sweeps_[2];
    for (int j = first; j <= last; ++j) {
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

void ImplicitDiffusion::solve(Field& right, Field& solution, const Slabs& slabs) {
    for (const int d : {1, 2}) {
        if (by_matrix_[static_cast<std::size_t>(d)]) {
            inverse_[static_cast<std::size_t>(d)].apply(right, scratch_, slabs);
            std::swap(right, scratch_);
            continue;
        }
        slabs.over(1, n_[d == 1 ? 2 : 1], [&](std::ptrdiff_t first, std::ptrdiff_t last) {
            if (d == 1)
                sweep_y(right, static_cast<int>(first), static_cast<int>(last));
            else
                sweep_z(right, static_cast<int>(first), static_cast<int>(last));
        });
    }
    inverse_[0].apply(right, solution, slabs);
}

}  // namespace grainsweep::flow
