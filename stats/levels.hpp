// Levels of the distribution of a response: quantiles, and probabilities to lie beyond a threshold, with errors.
//
//   F(t) = share of the values below t        quantile Q(q): linear between the values, at (N - 1) q
//
// The error e of a share is the Student-t 95 % half-width over the groups: independent sequences, else 8 consecutive
// batches. It is no smaller than
// - that of the first 1/2^k of each sequence times 2^(-3k/2), k = 1, 2, 3, as for moments (convergence.hpp), because
//   even sequences of a response that jumps at the threshold count alike;
// - that of rounding each group to whole values, 1.96/(n sqrt(12 R)), n values in each of R groups;
// - where fewer than 10 values lie on one side, the exact binomial interval (Clopper & Pearson 1934, Biometrika 26,
//   404): so few values differ too little between groups.
// Of a quantile the interval is Q(q - e) to Q(q + e), e of the share below it (Woodruff 1952, J. Am. Stat. Assoc. 47,
// 635), and its error the longer arm. There is no error where an arm leaves the sample.
//
// With a response model (assisted_moments.hpp) as control variate, m_s without sequence s and noise variance v:
//
//   F(t) = mean over s of [ mean over Q of P(m_s + noise < t) + mean over i in s of (1(z_i < t) - P(m_s(x_i) + noise
//   < t)) ]
//
// with the largest of (a) Student t over the sequences, (b) the scatter of the differences over the cases, (c) what
// normal residuals of the model's size would scatter, (d) how far F moves if the threshold moves by the misfit of the
// model, and in quadrature Student t over the scramblings of Q; the interval of a quantile by root finding.
#pragma once

#include "stats/moments.hpp"

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace grainsweep::stats {

/// The value below which a response lies with a probability.
struct Quantile {
    double probability = 0.5;  ///< in (0, 1)
    friend bool operator==(const Quantile&, const Quantile&) = default;
};

/// The probability of a response to lie above a threshold, or below it.
struct Exceedance {
    double threshold = 0;
    bool above = true;
    friend bool operator==(const Exceedance&, const Exceedance&) = default;
};

using Level = std::variant<Quantile, Exceedance>;

/// Returns "quantile:0.9", "above:2", "below:2".
[[nodiscard]] std::string to_string(const Level& level);
/// Returns the level of such a text; none: it is none.
[[nodiscard]] std::optional<Level> level_named(std::string_view word);

struct LevelEstimate {
    Level level;
    double value = std::numeric_limits<double>::quiet_NaN();
    double error = std::numeric_limits<double>::quiet_NaN();  ///< 95 % half-width
};

/// Values of a growing sample in groups that repeat it.
struct GroupedSample {
    std::span<const double> sorted;               ///< all of them, ascending
    std::vector<std::span<const double>> groups;  ///< each in the order of its points
    bool independent = false;                     ///< groups are independent sequences
    double repeated = 0;                          ///< sqrt(sum over runs of (w^2 - w/N)), Convergence::add
};

/// Returns the q-quantile of ascending values, at (N - 1) q and linear between them (type 7 of Hyndman & Fan 1996, Am.
/// Stat. 50, 361); q from 0 to 1, at least one value.
[[nodiscard]] double quantile_of_sorted(std::span<const double> sorted, double q);

/// Returns the consecutive batches that stand for groups where there are no independent sequences.
[[nodiscard]] std::vector<std::span<const double>> batches_of(std::span<const double> values);

/// Returns value and error. NaN: fewer than 4 values in a group, an arm of a quantile outside of the sample.
[[nodiscard]] LevelEstimate level_of(const Level& level, const GroupedSample& sample);

/// What a model says of the distribution: responses predicted without their own sequence.
struct LeftOutPredictions {
    std::vector<double> values;               ///< responses of the cases
    std::vector<double> predicted;            ///< of the cases
    std::vector<std::size_t> sequences;       ///< of the cases, 0 ... S - 1
    std::size_t scramblings = 1;              ///< equal parts of the integration points
    std::vector<std::vector<double>> spread;  ///< [sequence]: predictions at the integration points
    std::vector<double> noise;                ///< [sequence]: standard deviation of the noise
};

/// Returns value and error with the model. NaN where level_of has none, or fewer than 10 values lie beyond.
[[nodiscard]] LevelEstimate assisted_level_of(const Level& level, const LeftOutPredictions& model);

}  // namespace grainsweep::stats
