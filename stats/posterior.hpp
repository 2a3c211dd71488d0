// Samples of a probability density over the box [0, 1]^d, by Markov chains that need no tuning.
//
// Affine-invariant ensemble (Goodman & Weare 2010, Commun. Appl. Math. Comput. Sci. 5, 65; halves moved in turn as
// in Foreman-Mackey et al. 2013, section 3): walker X of one half moves along the line through a walker Y of the
// other, to Y + q (X - Y), q of density ~ 1/sqrt(q) on [1/2, 2], and is accepted with probability
// min(1, q^(d-1) p(new)/p(X)). Ridges of any slope are no harder than round distributions. Outside the box p = 0.
//
// A draw is addressed by (seed, step, walker): the same seed gives the same samples. Diagnostics: Sokal's
// autocorrelation time (window 5 tau), averaged over the walkers, and the split scale reduction R of Gelman et al.
// (2013, eq. 11.4), in which every half of a walker's path is a chain.
#pragma once

#include "stats/response_model.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

namespace grainsweep::stats {

/// Function that returns the log density (up to a constant) of each row; minus infinity or NaN: impossible.
using LogDensity = std::function<std::vector<double>(Rows points)>;

struct PosteriorSettings {
    std::size_t walkers = 0;     ///< even, at least 2 (d + 1); 0: the larger of 32 and 4 d
    std::size_t steps = 2000;    ///< steps kept of every walker
    std::size_t settling = 500;  ///< steps discarded before them
    std::size_t thinning = 10;   ///< one sample is taken every `thinning` steps
    std::uint64_t seed = 1;
};

struct PosteriorSample {
    std::vector<double> points;   ///< rows of d, in [0, 1]
    std::vector<double> density;  ///< log density of each row, up to a constant
    std::size_t dimensions = 0;
    double acceptance = 0;  ///< share of accepted moves
    double effective = 0;   ///< walkers times steps / (longest autocorrelation time of a coordinate)
    double scale_reduction =
        std::numeric_limits<double>::quiet_NaN();  ///< largest R of a coordinate; below 1.05: settled
    [[nodiscard]] Rows rows() const { return {points, dimensions}; }
};

/// Returns a sample of a density. `starts`: rows of high density, from which the walkers begin in turn, each moved by
/// up to 1 % of the box. Throws std::invalid_argument if no start is possible or the settings make no ensemble.
[[nodiscard]] PosteriorSample sample_posterior(const LogDensity& density, Rows starts,
                                               const PosteriorSettings& settings = {});

/// Shape of a sample: mean, covariance and principal directions.
struct PosteriorShape {
    std::vector<double> mean, sd;     ///< per coordinate
    std::vector<double> correlation;  ///< row-major
    std::vector<double> widths;       ///< sd along the principal directions, widest first
    std::vector<double> directions;   ///< one direction (unit length) per row, widest first
};

/// Returns the shape of at least two rows. A width near 0.29, the width of the whole box, means that the direction is
/// not identified.
[[nodiscard]] PosteriorShape posterior_shape(Rows sample);

}  // namespace grainsweep::stats
