// Distributions of a number, by the quantile function x(u), u in [0, 1].
//
//   normal      mean, sd
//   lognormal   median, sigma: the standard deviation of ln x
//   weibull     scale, shape: F(x) = 1 - exp(-(x/scale)^shape), x >= 0
//   gumbel      location, scale: F(x) = exp(-exp(-(x - location)/scale)), the largest of many draws
//   triangular  low <= mode <= high
//   beta        low + (high - low) Z, Z of the density z^(a-1) (1-z)^(b-1)/B(a, b)
//   sample      a column of rows of numbers (joint_sample.hpp)
//
// The first four may be truncated to [low, high]: with F the distribution function
// x(u) = F^-1(F(low) + u (F(high) - F(low))). They have no ends: u is kept 2^-32 away from 0 and 1, 6.2 standard
// deviations of a normal distribution. The upper half is computed from 1 - u, so both tails are equally exact.
#pragma once

#include "stats/joint_sample.hpp"

#include <limits>
#include <utility>
#include <variant>

namespace grainsweep::stats {

struct Normal {
    double mean = 0, sd = 1;
    bool operator==(const Normal&) const = default;
};

struct Lognormal {
    double median = 1, sigma = 1;
    bool operator==(const Lognormal&) const = default;
};

struct Weibull {
    double scale = 1, shape = 1;
    bool operator==(const Weibull&) const = default;
};

struct Gumbel {
    double location = 0, scale = 1;
    bool operator==(const Gumbel&) const = default;
};

struct Triangular {
    double low = 0, mode = 0.5, high = 1;
    bool operator==(const Triangular&) const = default;
};

struct Beta {
    double low = 0, high = 1, a = 1, b = 1;
    bool operator==(const Beta&) const = default;
};

class Distribution {
public:
    using Form = std::variant<Normal, Lognormal, Weibull, Gumbel, Triangular, Beta, SampleColumn>;

    /// Requires sd, median, sigma, scale, shape, a and b above 0, and low below high. `low` and `high` truncate a
    /// distribution without ends.
    explicit Distribution(Form form, double low = -std::numeric_limits<double>::infinity(),
                          double high = std::numeric_limits<double>::infinity());

    [[nodiscard]] const Form& form() const { return form_; }
    /// Returns the smallest value; without ends the truncation, which may be infinite.
    [[nodiscard]] double low() const { return low_; }
    [[nodiscard]] double high() const { return high_; }
    /// Returns whether x(0) = low and x(1) = high; false for the first four.
    [[nodiscard]] bool has_ends() const;
    /// Returns the probability that the truncation cuts off.
    [[nodiscard]] double cut() const { return has_ends() ? 0 : below_ + above_; }
    /// Returns low and high; for a distribution without ends the central 99.8 %, x(0.001) to x(0.999).
    [[nodiscard]] std::pair<double, double> range() const;

    /// Returns x(u), never beyond low and high, finite and not decreasing.
    [[nodiscard]] double quantile(double u) const;
    /// Returns u with x(u) = x: 0 below and 1 above all values.
    [[nodiscard]] double cumulative(double x) const;

    bool operator==(const Distribution&) const = default;

private:
    Form form_;
    double low_, high_;
    double below_ = 0, above_ = 0;  ///< probabilities that the truncation cuts off
};

}  // namespace grainsweep::stats
