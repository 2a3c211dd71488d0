#include "stats/response/triangular.hpp"

#include <algorithm>

namespace grainsweep::stats::response {
namespace {

constexpr Eigen::Index smallest = 64;

}  // namespace

void invert_lower(Eigen::Ref<Eigen::MatrixXd> lower) {
    const Eigen::Index n = lower.rows();
    if (n <= smallest) {
        // Column by column: M e_k by forward substitution from row k on.
        for (Eigen::Index k = 0; k < n; ++k) {
            Eigen::VectorXd column = Eigen::VectorXd::Zero(n - k);
            column(0) = 1;
            lower.bottomRightCorner(n - k, n - k).triangularView<Eigen::Lower>().solveInPlace(column);
            // Columns to the left of k are finished, those to the right are not read any more by themselves.
            lower.col(k).tail(n - k) = column;
        }
        return;
    }
    // [A 0; B C]^-1 = [A^-1 0; -C^-1 B A^-1 C^-1]
    const Eigen::Index half = n / 2;
    auto corner = lower.bottomLeftCorner(n - half, half);
    invert_lower(lower.topLeftCorner(half, half));
    invert_lower(lower.bottomRightCorner(n - half, n - half));
    const Eigen::MatrixXd product = corner * lower.topLeftCorner(half, half).triangularView<Eigen::Lower>();
    corner.noalias() = -(lower.bottomRightCorner(n - half, n - half).triangularView<Eigen::Lower>() * product);
}

Eigen::MatrixXd gram_of_lower(const Eigen::Ref<const Eigen::MatrixXd>& lower) {
    const Eigen::Index n = lower.rows(), block = 128;
    Eigen::MatrixXd gram(n, n);
    Eigen::MatrixXd m = lower.triangularView<Eigen::Lower>();
    for (Eigen::Index j = 0; j < n; j += block) {
        const Eigen::Index width = std::min(block, n - j), below = n - j;
        // Rows above j of block column j are zero: the sum runs from row j on.
        gram.block(j, 0, width, j + width).noalias() =
            m.block(j, j, below, width).transpose() * m.block(j, 0, below, j + width);
    }
    gram.triangularView<Eigen::StrictlyUpper>() = gram.transpose();
    return gram;
}

Eigen::VectorXd gram_diagonal_of_lower(const Eigen::Ref<const Eigen::MatrixXd>& lower) {
    Eigen::VectorXd diagonal(lower.cols());
    for (Eigen::Index j = 0; j < lower.cols(); ++j) diagonal(j) = lower.col(j).tail(lower.rows() - j).squaredNorm();
    return diagonal;
}

}  // namespace grainsweep::stats::response
