// What a response model keeps: inside stats/ only.
#pragma once

#include "stats/response/kriging.hpp"
#include "stats/response/local_noise.hpp"
#include "stats/response_model.hpp"

#include <Eigen/Core>

namespace grainsweep::stats {

struct ResponseModel::State {
    Eigen::VectorXd low, high;     ///< box
    double offset = 0, scale = 1;  ///< response = offset + scale z
    bool logarithm = false;        ///< its logarithm is
    response::Kriging kriging;
    response::LocalNoise noise;
    ModelQuality quality;

    [[nodiscard]] double standardised(double response) const;
    /// Mean response where z has that mean: of a logarithm with normal noise g, exp(offset + scale z + scale^2 g/2).
    [[nodiscard]] double mean_at(double z) const;
    /// Standard deviation about that mean where z has that variance: of a logarithm, mean sqrt(exp(scale^2 v) - 1).
    [[nodiscard]] double deviation(double mean, double variance) const;
    /// Features in [0, 1] of the box, (m, d).
    [[nodiscard]] Eigen::MatrixXd in_box(Rows points) const;
};

}  // namespace grainsweep::stats
