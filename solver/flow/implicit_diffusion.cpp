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

void ImplicitDiffusion::sweep(int d, Field& field, int first, int last) const {
    const auto axis = static_cast<std::size_t>(d);
    const Sweep& s = sweeps_[axis];
    const auto stride = field.stride(d);
    for (int other = first; other <= last; ++other) {
        const auto row_at = [&](int along) {
            return field.data() + (d == 1 ? field.index(1, along, other) : field.index(1, other, along));
        };
        for (int along = s.first; along <= n_[axis]; ++along) {
            const auto m = static_cast<std::size_t>(along);
            double* const row = row_at(along);
            eliminate(row, row - stride, n_[0], s.low[m], s.inverse_pivot[m]);
        }
        for (int along = n_[axis] - 1; along >= s.first; --along) {
            double* const row = row_at(along);
            substitute(row, row + stride, n_[0], s.high_over_pivot[static_cast<std::size_t>(along)]);
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
            sweep(d, right, static_cast<int>(first), static_cast<int>(last));
        });
    }
    inverse_[0].apply(right, solution, slabs);
}

}  // namespace grainsweep::flow
