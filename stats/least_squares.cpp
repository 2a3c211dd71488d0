#include "stats/least_squares.hpp"

#include <cmath>
#include <limits>
#include <utility>

namespace grainsweep::stats {

// A P = Q R with orthonormal Q: each column taken is removed from those that follow and from y. R b = Q^T y gives b.
Eigen::VectorXd least_squares(Eigen::MatrixXd columns, Eigen::VectorXd y) {
    const Eigen::Index p = columns.cols();
    Eigen::MatrixXd r = Eigen::MatrixXd::Zero(p, p);
    Eigen::VectorXd of_y(p), b = Eigen::VectorXd::Zero(p);
    Eigen::VectorX<Eigen::Index> order(p);
    for (Eigen::Index k = 0; k < p; ++k) order(k) = k;
    double least = 0;
    Eigen::Index rank = 0;
    for (; rank < p; ++rank) {
        Eigen::Index longest = rank;
        double length = -1;
        for (Eigen::Index k = rank; k < p; ++k)
            if (const double norm = columns.col(order(k)).norm(); norm > length) length = norm, longest = k;
        if (rank == 0) least = static_cast<double>(p) * std::numeric_limits<double>::epsilon() * length;
        if (!(length > least)) break;
        std::swap(order(rank), order(longest));
        const Eigen::Index taken = order(rank);
        columns.col(taken) /= length;
        r(taken, taken) = length;
        of_y(rank) = columns.col(taken).dot(y);
        y -= of_y(rank) * columns.col(taken);
        for (Eigen::Index k = rank + 1; k < p; ++k) {
            r(taken, order(k)) = columns.col(taken).dot(columns.col(order(k)));
            columns.col(order(k)) -= r(taken, order(k)) * columns.col(taken);
        }
    }
    for (Eigen::Index k = rank; k-- > 0;) {
        double rest = of_y(k);
        for (Eigen::Index later = k + 1; later < rank; ++later) rest -= r(order(k), order(later)) * b(order(later));
        b(order(k)) = rest / r(order(k), order(k));
    }
    return b;
}

}  // namespace grainsweep::stats
