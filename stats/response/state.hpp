// Data of a fitted response model; for use inside stats/ only.
#pragma once

#include "stats/response/kriging.hpp"
#include "stats/response/local_noise.hpp"
#include "stats/response_model.hpp"

#include <Eigen/Core>

namespace grainsweep::stats {

struct ResponseModel::State {
    Eigen::VectorXd low, high;     ///< box
    double offset = 0, scale = 1;  ///< response = offset + scale z
    bool logarithm = false;        ///< the logarithm of the response = offset + scale z
    response::Kriging kriging;
    response::LocalNoise noise;
    ModelQuality quality;

    [[nodiscard]] double standardised(double response) const;
    /// Returns the mean response for the mean z; for a logarithm with a normal scatter v it is exp(offset + scale z +
    /// scale^2 v/2).
    [[nodiscard]] double mean_at(double z) const;
    /// Return the parts of g that are scatter of single runs, and error of the mean.
    [[nodiscard]] double scatter() const { return quality.noise == Noise::scatter ? kriging.h.noise() : 0; }
    [[nodiscard]] double misfit() const { return kriging.h.noise() - scatter(); }
    /// Returns the standard deviation around the mean for the variance v of z; for a logarithm it is mean
    /// sqrt(exp(scale^2 v) - 1).
    [[nodiscard]] double deviation(double mean, double variance) const;
    /// Returns the features scaled to [0, 1] of the box, (m, d).
    [[nodiscard]] Eigen::MatrixXd in_box(Rows points) const;
};

}  // namespace grainsweep::stats
