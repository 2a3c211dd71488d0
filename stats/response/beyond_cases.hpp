// What a model of the response as control variate (stats/assisted_moments.hpp) says beyond the outermost cases, and its
// error in the moments E[z^p]. With the closure g_p = E[z^p | m, v] = m, m^2 + v, m^3 + 3 m v, m^4 + 6 m^2 v + 3 v^2 of
// a normal z of mean m and variance v:
//
// - Of each end of a feature |gradient . sum over the 4 outermost cases of (z^p - g_p)/n|, g_p predicted from all
// others.
// - u times the error that tails without a visible end give a sample (stats/tail.hpp). u is three times the missed part
//   of the outermost 2, 4 or 8 cases, the largest: rms of z - m over rms of z, without noise. If the points of the
//   integral reach 1.5 times as far beyond an outermost case as that is from the eighth, u is 0.3 at least, and tails
//   have no end either.
#pragma once

#include "stats/moment_statistics.hpp"
#include "stats/response/kriging.hpp"
#include "stats/tail.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <span>
#include <vector>

namespace grainsweep::stats::response {

/// Returns E[z^p | m, v], p = 1 ... 4.
[[nodiscard]] RawMoments closure(double m, double v);
[[nodiscard]] double dot(const RawMoments& gradient, const RawMoments& moments);
/// Returns Var[sum_p gradient_p (m + s e)^p] for a standard normal e.
[[nodiscard]] double normal_variance(const RawMoments& gradient, double m, double s);

/// Number of cases of an edge.
inline constexpr std::size_t outermost = 4;

class BeyondCases {
public:
    /// Takes standardised responses of so many sequences.
    BeyondCases(std::span<const double> z, std::size_t sequences);

    /// Adds one of two models: `inverse`, inverse_of(model); `x`, features of its cases; `q`, of the points of the
    /// integral; `v`, its noise variance.
    void add(const Kriging& model, const Eigen::MatrixXd& inverse, const Eigen::MatrixXd& x, const Eigen::MatrixXd& q,
             double v);

    /// Returns whether a tail of the responses surely has no end.
    [[nodiscard]] bool endless() const;
    /// Returns whether a model says nothing of a tail that may have no end: it misses a tenth of the outermost cases,
    /// or 3 % where there surely is none.
    [[nodiscard]] bool says_nothing() const;
    /// Returns the missed part of the outermost cases, the largest over the edges.
    [[nodiscard]] double unforeseen() const { return unforeseen_; }
    /// Returns the 95 % half-width of gradient . M by both errors of the header.
    [[nodiscard]] double half_width(const RawMoments& gradient) const;

private:
    struct Edge {
        RawMoments missed{};  ///< sum of (z^p - g_p)/n
        std::vector<double> predicted;
        double noise = 0;       ///< standard deviation of a single run
        double unforeseen = 0;  ///< the missed part of these cases
    };

    static std::vector<Edge> edges_of(const Kriging& model, const Eigen::MatrixXd& inverse,
                                      const std::vector<std::vector<Eigen::Index>>& ends, double v);

    std::vector<double> sorted_;
    std::size_t sequences_;
    std::vector<Tail> tails_;
    std::vector<Edge> edges_;
    double unforeseen_ = 0;
    bool far_out_ = false;
};

}  // namespace grainsweep::stats::response
