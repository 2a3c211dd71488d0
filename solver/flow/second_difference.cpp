#include "solver/flow/second_difference.hpp"

namespace grainsweep::flow {

SecondDifference::SecondDifference(const Axis& axis, const Edge& edge)
    : low(static_cast<std::size_t>(axis.cells()) + 2, 0.0), high(low) {
    for (int i = first_unknown(edge); i <= axis.cells(); ++i) {
        const auto at = static_cast<std::size_t>(i);
        if (edge.on_faces) {
            low[at] = 1 / (axis.spacing(i) * axis.width(i - 1));
            high[at] = 1 / (axis.spacing(i) * axis.width(i));
        } else {
            low[at] = 1 / (axis.width(i) * axis.spacing(i));
            high[at] = 1 / (axis.width(i) * axis.spacing(i + 1));
        }
    }
}

Eigen::MatrixXd second_difference_matrix(const Axis& axis, const Edge& edge) {
    const int n = axis.cells();
    const SecondDifference difference(axis, edge);
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
    for (int i = first_unknown(edge); i <= n; ++i) {
        const double low = difference.low[static_cast<std::size_t>(i)];
        const double high = difference.high[static_cast<std::size_t>(i)];
        const int row = i - 1;
        matrix(row, row) -= low + high;
        const auto couple = [&](int neighbour, double weight) {
            if (neighbour >= first_unknown(edge) && neighbour <= n) {
                matrix(row, neighbour - 1) += weight;
            } else if (edge.periodic) {
                matrix(row, neighbour < 1 ? n - 1 : 0) += weight;
            } else if (!edge.on_faces) {
                matrix(row, row) += weight * edge.ghost[neighbour < 1 ? 0 : 1].sign;
            }  // else: a value on a wall, which is known
        };
        couple(i - 1, low);
        couple(i + 1, high);
    }
    return matrix;
}

}  // namespace grainsweep::flow
