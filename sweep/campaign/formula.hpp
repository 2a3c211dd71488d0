// Expressions over named numbers: "3 * diameter", "if(speed > 1, sqrt(gap), 0)". Evaluated by muParser.
#pragma once

#include "sweep/campaign/wrong_question.hpp"

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace grainsweep::campaign {

/// Formula of numbers, names, + - * / ^, comparisons (1 or 0), && ||, parentheses, `pi` and the functions
/// min, max (any number of arguments), abs, sqrt, exp, log (natural), sin, cos, tan (of radians), atan2, pow, floor,
/// if(condition, value, otherwise). Has no state, and its result depends on no locale. Copies share one formula; any
/// thread may evaluate it.
class Formula {
public:
    using Lookup = std::function<double(std::string_view name)>;

    /// Checks the text completely. Names stand for what `names` lists; such a name hides `pi`. Otherwise returns why
    /// not, as a part of a sentence, with the position in the text (1: its first character) and the nearest right word.
    [[nodiscard]] static std::variant<Formula, std::string> parse(std::string_view text, const WordList& names);

    /// The names it needs, each once, in the order of their first use.
    [[nodiscard]] const std::vector<std::string>& names() const;
    /// The text without blanks and superfluous signs: equal for formulas that differ in nothing else.
    [[nodiscard]] const std::string& text() const;
    /// Its value, not finite where it has none: log(0), 1/0, sqrt(-1), or a name that stands for such a value.
    [[nodiscard]] double operator()(const Lookup& value_of) const;

private:
    struct Compiled;
    explicit Formula(std::shared_ptr<Compiled> compiled);

    std::shared_ptr<Compiled> compiled_;
};

}  // namespace grainsweep::campaign
