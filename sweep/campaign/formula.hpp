// Expressions of named numbers: "3 * diameter", "if(speed > 1, sqrt(gap), 0)". Evaluated by muParser.
#pragma once

#include "sweep/campaign/input_error.hpp"

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace grainsweep::campaign {

/// Formula of numbers, names, + - * / ^, comparisons (1 or 0), && ||, parentheses, `pi` and the functions
/// min, max (any number of arguments), abs, sqrt, exp, log (natural), log10, sin, cos, tan (of radians), asin, acos,
/// atan, atan2, pow, floor, ceil, round, if(condition, value, otherwise). It has no state, and its result does not
/// depend on the locale. Copies share one formula; any thread may evaluate it.
class Formula {
public:
    using Lookup = std::function<double(std::string_view name)>;
    using Known = std::function<bool(std::string_view name)>;

    /// Parses and checks a text that may use `names`; a name `pi` hides the constant. If the text is invalid, returns
    /// the reason as a part of a sentence, with the position in the text (1: its first character) and the nearest valid
    /// word.
    [[nodiscard]] static std::variant<Formula, std::string> parse(std::string_view text, const WordList& names);
    /// Parses a text that may use those names in it that are `known`. Remembers it: every case of a machine reads the
    /// same texts.
    [[nodiscard]] static std::variant<Formula, std::string> of(std::string_view text, const Known& known);

    /// Returns the names that it uses, each once, in the order of their first use.
    [[nodiscard]] const std::vector<std::string>& names() const;
    /// Returns the text without blanks and superfluous signs, which is equal for formulas that differ only in these.
    [[nodiscard]] const std::string& text() const;
    /// Returns its value; not finite if it is undefined: log(0), 1/0, sqrt(-1), or a name with such a value.
    [[nodiscard]] double operator()(const Lookup& value_of) const;

private:
    struct Compiled;
    explicit Formula(std::shared_ptr<Compiled> compiled);

    std::shared_ptr<Compiled> compiled_;
};

/// Returns the names in a text that are known.
[[nodiscard]] std::vector<std::string> names_in(std::string_view text, const Formula::Known& known);

}  // namespace grainsweep::campaign
