// Condition of a process window: comparisons of observables and factors with numbers, joined by and, or, not.
//
//   condition  = every { "or" every },   every = single { "and" single }
//   single     = "not" single | "(" condition ")" | comparison
//   comparison = value op number | number op value | value "between" number "and" number,   op: < <= > >=
//   value      = NAME | NAME "/" NAME
//   number     = NUMBER | NUMBER UNIT    without a unit: in that of the value
//
// An undefined value makes a comparison neither true nor false, as NULL does in SQL. The condition holds only if it is
// true.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::study {

class Condition {
public:
    /// Parses a condition of the given names, whose values are in `units` (one per name, or none at all). Throws
    /// InputError at --where with the expected words and the nearest name, or with a unit that does not fit.
    [[nodiscard]] static Condition read(std::string_view text, std::span<const std::string> names,
                                        std::span<const std::string> units = {});

    /// Returns whether the condition holds. `values`: one per name; NaN: undefined.
    [[nodiscard]] bool holds(std::span<const double> values) const;
    /// Returns the indices of the compared names, in the order of their first mention.
    [[nodiscard]] std::vector<std::size_t> compared() const;
    /// Returns the direction in which a name is bounded: +1 only from below, -1 only from above, 0 both.
    [[nodiscard]] int direction(std::size_t name) const;

private:
    enum class Kind { below, at_most, above, at_least, all, any, none };
    struct Node {
        Kind kind = Kind::all;
        std::size_t name = 0;
        std::optional<std::size_t> over = {};  ///< the name by which the value is divided
        double number = 0;
        std::size_t first = 0, second = 0;  ///< operands: a range of nodes for all and any, `first` for none
    };
    friend class ConditionReader;
    [[nodiscard]] std::optional<bool> decide(std::size_t node, std::span<const double> values) const;
    void collect(std::size_t node, bool negated, std::size_t name, bool& from_below, bool& from_above) const;

    std::vector<Node> nodes_;  ///< the last is the root
};

}  // namespace grainsweep::study
