// Checks and changes of an expression's text before SQLite parses it. Conditions are about quantities, so two rules of
// SQL do not apply. In SQL the quotient of whole numbers is a whole number (1/2 is 0). And a comparison is a number
// that can be compared again: 0.2 < a < 0.5 is (0.2 < a) < 0.5, always true.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace grainsweep::store {

/// Returns whether brackets are unbalanced. Brackets in quotes and comments do not count.
[[nodiscard]] bool unbalanced(std::string_view expression);

/// Returns the expression with real quotients: "a*1.0/b" for "a/b". The factor stands left of the division, so the
/// order of evaluation does not change: a * b / c is a * b *1.0/ c.
[[nodiscard]] std::string with_real_division(std::string_view expression);

/// Consecutive comparisons without AND, OR or brackets between them.
struct ChainedComparison {
    std::string_view text;  ///< "0.2 < a < 0.5"
    std::string meant;      ///< "0.2 < a AND a < 0.5"; empty if it contains a BETWEEN
};
[[nodiscard]] std::optional<ChainedComparison> chained_comparison(std::string_view expression);

}  // namespace grainsweep::store
