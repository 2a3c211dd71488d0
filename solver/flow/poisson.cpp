#include "solver/flow/poisson.hpp"

#include "solver/flow/dense_product.hpp"
#include "solver/flow/second_difference.hpp"

#include <Eigen/Eigenvalues>

#include <cmath>

namespace grainsweep::flow {
namespace {

std::vector<double> row_major(const Eigen::MatrixXd& matrix) {
    std::vector<double> entries;
    for (Eigen::Index r = 0; r < matrix.rows(); ++r)
        for (Eigen::Index c = 0; c < matrix.cols(); ++c) entries.push_back(matrix(r, c));
    return entries;
}

}  // namespace

Poisson::Poisson(const Grid& grid, const Sides& sides)
    : n_{grid.cells(0), grid.cells(1), grid.cells(2)}, scratch_(grid.total_cells()) {
    const Edges edges = pressure_edges(sides);
    std::array<Eigen::VectorXd, 3> eigenvalues;
    for (int d = 0; d < 3; ++d) {
        const auto at = static_cast<std::size_t>(d);
        const Axis& axis = grid[d];
        Eigen::VectorXd root(axis.cells());  // sqrt(width) makes the operator symmetric
        for (int i = 1; i <= axis.cells(); ++i) root(i - 1) = std::sqrt(axis.width(i));
        const Eigen::MatrixXd similar =
            root.asDiagonal() * second_difference_matrix(axis, edges[at]) * root.cwiseInverse().asDiagonal();
        const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(0.5 * (similar + similar.transpose()));
        eigenvalues[at] = solver.eigenvalues();
        eigenvalues[at](axis.cells() - 1) = 0;  // the largest: the constant, whose eigenvalue is exactly zero
        const Eigen::MatrixXd forward = solver.eigenvectors().transpose() * root.asDiagonal();
        const Eigen::MatrixXd back = root.cwiseInverse().asDiagonal() * solver.eigenvectors();
        forward_[at] = row_major(d == 0 ? Eigen::MatrixXd(forward.transpose()) : forward);
        back_[at] = row_major(d == 0 ? Eigen::MatrixXd(back.transpose()) : back);
    }
    for (Eigen::Index k = 0; k < n_[2]; ++k)
        for (Eigen::Index j = 0; j < n_[1]; ++j)
            for (Eigen::Index i = 0; i < n_[0]; ++i) {
                const double sum = eigenvalues[0](i) + eigenvalues[1](j) + eigenvalues[2](k);
                inverse_eigenvalue_.push_back(sum < 0 ? 1 / sum : 0);
            }
}

void Poisson::transform(Way way, const std::vector<double>& from, std::vector<double>& to, int direction,
                        std::ptrdiff_t first, std::ptrdiff_t last) const {
    const auto [nx, ny, nz] = n_;
    const auto& matrix = (way == Way::forward ? forward_ : back_)[static_cast<std::size_t>(direction)];
    if (direction == 0) {
        const std::ptrdiff_t start = first * ny * nx;
        dense_product((last - first + 1) * ny, nx, nx, from.data() + start, nx, matrix.data(), nx, to.data() + start,
                      nx);
    } else if (direction == 1) {
        for (std::ptrdiff_t k = first; k <= last; ++k)
            dense_product(ny, nx, ny, matrix.data(), ny, from.data() + k * ny * nx, nx, to.data() + k * ny * nx, nx);
    } else {
        const std::ptrdiff_t start = first * nx;
        dense_product(nz, (last - first + 1) * nx, nz, matrix.data(), nz, from.data() + start, ny * nx,
                      to.data() + start, ny * nx);
    }
}

void Poisson::solve(std::vector<double>& values, const Slabs& slabs) {
    const auto [nx, ny, nz] = n_;
    slabs.over(0, nz - 1, [&](std::ptrdiff_t first, std::ptrdiff_t last) {
        transform(Way::forward, values, scratch_, 0, first, last);
        transform(Way::forward, scratch_, values, 1, first, last);
    });
    slabs.over(0, ny - 1, [&, width = nx, depth = nz, plane = nx * ny](std::ptrdiff_t first, std::ptrdiff_t last) {
        transform(Way::forward, values, scratch_, 2, first, last);
        for (std::ptrdiff_t k = 0; k < depth; ++k) {
            double* const part = scratch_.data() + k * plane;
            const double* const inverse = inverse_eigenvalue_.data() + k * plane;
            for (std::ptrdiff_t m = first * width; m < (last + 1) * width; ++m) part[m] *= inverse[m];
        }
        transform(Way::back, scratch_, values, 2, first, last);
    });
    slabs.over(0, nz - 1, [&](std::ptrdiff_t first, std::ptrdiff_t last) {
        transform(Way::back, values, scratch_, 1, first, last);
        transform(Way::back, scratch_, values, 0, first, last);
    });
}

}  // namespace grainsweep::flow
