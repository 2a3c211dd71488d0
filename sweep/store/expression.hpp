// SQL expressions of a case's inputs, evaluated by SQLite: the `where` clause, and numbers computed from inputs. Two
// rules differ from SQL (expression.cpp): a quotient is real, and chained comparisons are refused.
#pragma once

#include "sweep/campaign/campaign.hpp"

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::store {

/// Compiles `expression` of the given parameter names. Only deterministic operators and functions are permitted (no
/// sub-select, random() or clock). Throws InputError (at $.where) with SQLite's message, and the nearest name for an
/// unknown column. An empty expression accepts every case. NULL counts as false.
[[nodiscard]] campaign::Filter make_filter(std::string_view expression, std::span<const std::string> names);

/// Compiled condition and the names that it reads.
struct Condition {
    campaign::Filter holds;
    std::vector<std::string> reads;
};
/// Compiles a non-empty condition at `path` in the same way.
[[nodiscard]] Condition make_condition(std::string_view expression, std::span<const std::string> names,
                                       std::string_view path);

/// Function from values, in the order of the names, to one number per expression; NaN if an expression has no number
/// (NULL, text).
using Numbers = std::function<std::vector<double>(std::span<const Value> values)>;

/// Compiles expressions of the given names, under the rules of make_filter; each must read at least one name. Errors of
/// the k-th expression name `path`[k]. An evaluation takes about a microsecond.
[[nodiscard]] Numbers make_numbers(std::span<const std::string> expressions, std::span<const std::string> names,
                                   std::string_view path);

}  // namespace grainsweep::store
