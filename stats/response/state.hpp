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
    response::Kriging kriging;
    response::LocalNoise noise;
    ModelQuality quality;

    /// Features in [0, 1] of the box, (m, d).
    [[nodiscard]] Eigen::MatrixXd in_box(Rows points) const;
};

}  // namespace grainsweep::stats
