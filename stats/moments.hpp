// Moments in one pass, with exact merging.
//
//   mean = sum x / n,  m_k = sum (x - mean)^k / n
//   sd = sqrt(m2)      (divides by n)            g1 = m3 / m2^(3/2)      kurtosis = m4 / m2^2 (3 for a normal)
//   skewness = 3 (mean - median) / sd            (Pearson's second)
//
// Updates and merges: Welford (1962); Pebay (2008), Sandia report SAND2008-6212, eq. 1.5-1.6, 2.1. Two measures keep
// the error near machine precision for any length and offset of the data. The first finite value is subtracted from
// all, and values are gathered in chunks of 1000 that are merged, not added one by one.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>

namespace grainsweep::stats {

enum class Statistic { mean, sd, skewness, g1, kurtosis };

inline constexpr std::array statistics = {Statistic::mean, Statistic::sd, Statistic::skewness, Statistic::g1,
                                          Statistic::kurtosis};

[[nodiscard]] std::string_view to_string(Statistic statistic);
[[nodiscard]] std::optional<Statistic> statistic_named(std::string_view word);

/// Statistics of a sample. NaN: undefined (no values; skewness, g1 and kurtosis of equal values) or not representable.
struct Summary {
    std::int64_t count = 0;     ///< finite values, from which all statistics are computed
    std::int64_t excluded = 0;  ///< NaN and infinite values left out
    double mean = std::numeric_limits<double>::quiet_NaN();
    double sd = std::numeric_limits<double>::quiet_NaN();        ///< divides by count
    double skewness = std::numeric_limits<double>::quiet_NaN();  ///< Pearson's second, 3 (mean - median)/sd
    double g1 = std::numeric_limits<double>::quiet_NaN();        ///< moment skewness
    double kurtosis = std::numeric_limits<double>::quiet_NaN();  ///< not excess
    double median = std::numeric_limits<double>::quiet_NaN();
    double minimum = std::numeric_limits<double>::quiet_NaN();
    double maximum = std::numeric_limits<double>::quiet_NaN();
    double zero_share = std::numeric_limits<double>::quiet_NaN();  ///< share of values that are exactly 0
    /// False if a power sum overflowed or vanished in double precision; statistics that need it are NaN.
    bool representable = true;

    [[nodiscard]] double of(Statistic statistic) const;
};

/// Middle value of a sorted sample, or the middle two if their number is even.
struct Middle {
    double low = std::numeric_limits<double>::quiet_NaN();
    double high = std::numeric_limits<double>::quiet_NaN();
    [[nodiscard]] double median() const;
};

/// Accumulator of values that does not store them. It gives all statistics except the median.
class Moments {
public:
    /// Adds a value. Non-finite values are counted and left out.
    void add(double value);
    void add(std::span<const double> values);
    /// Adds the values of another accumulator.
    void merge(const Moments& other);

    [[nodiscard]] std::int64_t count() const { return total_.count + chunk_.count; }
    [[nodiscard]] std::int64_t excluded() const { return excluded_; }
    /// Returns all statistics except median and skewness (NaN).
    [[nodiscard]] Summary summary() const;
    /// Returns all statistics, given the middle of the same values.
    [[nodiscard]] Summary summary(Middle middle) const;

private:
    /// Count, mean and sums of powers of deviations, of values minus the shift.
    struct Sums {
        std::int64_t count = 0;
        double mean = 0;
        double m2 = 0;
        double m3 = 0;
        double m4 = 0;
        void add(double x);
        void merge(const Sums& other, double shift_difference);
    };

    [[nodiscard]] Sums all() const;

    double shift_ = 0;
    Sums total_;
    Sums chunk_;
    std::int64_t excluded_ = 0;
    std::int64_t zeros_ = 0;
    double minimum_ = std::numeric_limits<double>::infinity();
    double maximum_ = -std::numeric_limits<double>::infinity();
};

/// Returns the middle of the finite values; NaN if there are none. Linear time.
[[nodiscard]] Middle middle(std::span<const double> values);

[[nodiscard]] Summary summarise(std::span<const double> values);

}  // namespace grainsweep::stats
