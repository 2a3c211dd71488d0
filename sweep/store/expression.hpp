// SQL expressions over a case's inputs, evaluated by SQLite itself: the `where` clause, and numbers made of inputs.
// Two rules differ from SQL (expression_text.hpp): a quotient is real, and comparisons are not chained.
#pragma once

#include "sweep/campaign/campaign.hpp"

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::store {

/// Compiles `expression` over the given parameter names. Deterministic operators and functions only (no
/// sub-select, no random(), no clock). Throws WrongQuestion (at $.where) with SQLite's own words, and the
/// nearest name for an unknown column. An empty expression accepts everything. NULL counts as false.
[[nodiscard]] campaign::Filter make_filter(std::string_view expression, std::span<const std::string> names);

/// A compiled condition and the names that it reads.
struct Condition {
    campaign::Filter holds;
    std::vector<std::string> reads;
};
/// The same for a condition at `path` that is not empty.
[[nodiscard]] Condition make_condition(std::string_view expression, std::span<const std::string> names,
                                       std::string_view path);

/// Values in the order of the names given -> one number per expression; NaN where an expression has none (NULL, text).
using Numbers = std::function<std::vector<double>(std::span<const Value> values)>;

/// Compiles expressions over the given names, under the rules of make_filter; each must read at least one name. The
/// k-th is at `path`[k] in what is thrown. Each evaluation takes about a microsecond.
[[nodiscard]] Numbers make_numbers(std::span<const std::string> expressions, std::span<const std::string> names,
                                   std::string_view path);

}  // namespace grainsweep::store
