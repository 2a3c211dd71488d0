// The text of an expression before SQLite reads it. A condition is about quantities, so two rules of SQL do not apply.
// In SQL the quotient of whole numbers is a whole number (1/2 is 0). And a comparison is a number that can be compared
// again: 0.2 < a < 0.5 is (0.2 < a) < 0.5, always true.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace grainsweep::store {

/// Whether a bracket closes that was not opened, or stays open. Text in quotes and comments have none.
[[nodiscard]] bool unbalanced(std::string_view expression);

/// The expression with every quotient a real one: "a*1.0/b" for "a/b". The factor stands left of the divisor, so that
/// the order of evaluation stays: a * b / c is a * b *1.0/ c.
[[nodiscard]] std::string with_real_division(std::string_view expression);

/// Comparisons in a row that no AND, OR or bracket divides.
struct ChainedComparison {
    std::string_view text;  ///< "0.2 < a < 0.5"
    std::string meant;      ///< "0.2 < a AND a < 0.5"; empty where a BETWEEN is among them
};
[[nodiscard]] std::optional<ChainedComparison> chained_comparison(std::string_view expression);

}  // namespace grainsweep::store
