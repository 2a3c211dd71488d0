// Distribution of a factor as text, in the identity of a campaign and in sentences, and its figures by their keys.
//
//   normal MEAN SD within LOW HIGH             lognormal MEDIAN SIGMA within LOW HIGH
//   weibull SCALE SHAPE within LOW HIGH        gumbel LOCATION SCALE within LOW HIGH
//   triangular LOW MODE HIGH                   beta LOW HIGH A B
//   sample K of N in HASH: V V ...             column K of the N that are used of one file, all its values; HASH is
//                                              that of all N columns
#pragma once

#include "stats/distribution.hpp"

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace grainsweep::campaign {

[[nodiscard]] std::string stated_text(const stats::Distribution& distribution);

/// Column of a sample; others have its other columns.
struct StatedColumn {
    std::size_t column = 0;  ///< from 0
    std::string sample;      ///< hash
    std::vector<double> values;
};
/// Returns the column of a distribution that is one.
[[nodiscard]] std::optional<StatedColumn> stated_column(const stats::Distribution& distribution);
/// Returns the distribution or column in a text of stated_text(); empty: the text has no distribution.
[[nodiscard]] std::variant<std::monostate, stats::Distribution, StatedColumn> distribution_in(std::string_view text);

// Return the key of a factor with this distribution, and its figures by their keys; not of a sample.
[[nodiscard]] std::string_view name_of(const stats::Distribution& distribution);
[[nodiscard]] std::map<std::string, double> figures_of(const stats::Distribution& distribution);

/// Returns the text without the values of a sample, for a sentence.
[[nodiscard]] std::string_view without_values(std::string_view text);

/// Returns a text such as "normal, mean 3.4e-05, sd 3e-06" or "column 1 of 2 of a sample of 4000 rows".
[[nodiscard]] std::string described(const stats::Distribution& distribution);

}  // namespace grainsweep::campaign
