#include "sweep/study/condition.hpp"

#include "solver/plain_text.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/plain_name.hpp"
#include "sweep/campaign/quantity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>

namespace grainsweep::study {

/// Recursive descent over the text; `nodes_` of the condition grow as parts are understood.
class ConditionReader {
public:
    ConditionReader(std::string_view text, std::span<const std::string> names, std::span<const std::string> units)
        : text_(text), names_(names), units_(units) {}

    Condition read() {
        any();
        skip();
        if (at_ != text_.size()) refuse("and, or, or the end is expected");
        return std::move(condition_);
    }

private:
    using Kind = Condition::Kind;
    using Node = Condition::Node;
    static constexpr int deepest = 200, most_comparisons = 100;

    [[noreturn]] void refuse(std::string_view expected, std::string_view suggestion = {}) const {
        const auto rest = text_.substr(at_, 30);
        throw campaign::input_error(
            "--where", text_,
            fmt::format("{} at {}; a condition compares observables and factors with numbers by <, <=, >, >= or "
                        "between, joined by and, or, not and brackets",
                        expected, rest.empty() ? "its end" : fmt::format("'{}'", rest)),
            suggestion);
    }

    std::size_t add(Node node) {
        condition_.nodes_.push_back(node);
        return condition_.nodes_.size() - 1;
    }

    void skip() {
        while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_])) != 0) ++at_;
    }

    [[nodiscard]] std::string_view word_ahead() {
        skip();
        std::size_t end = at_;
        if (end < text_.size() && std::isdigit(static_cast<unsigned char>(text_[end])) != 0) return {};
        while (end < text_.size() && campaign::is_name_sign(text_[end])) ++end;
        return text_.substr(at_, end - at_);
    }

    bool take(std::string_view keyword) {
        const auto word = word_ahead();
        const bool same = campaign::small_letters(word) == keyword;
        if (same) at_ += word.size();
        return same;
    }

    bool take_sign(char sign) {
        skip();
        if (at_ >= text_.size() || text_[at_] != sign) return false;
        ++at_;
        return true;
    }

    std::size_t any() {
        auto node = all();
        while (take("or")) node = add({.kind = Kind::any, .first = node, .second = all()});
        return node;
    }

    std::size_t all() {
        auto node = single();
        while (take("and")) node = add({.kind = Kind::all, .first = node, .second = single()});
        return node;
    }

    std::size_t single() {
        if (++depth_ > deepest) refuse("fewer brackets are expected");
        std::size_t node = 0;
        if (take("not")) {
            const auto inner = single();
            node = add({.kind = Kind::none, .first = inner});
        } else if (take_sign('(')) {
            node = any();
            if (!take_sign(')')) refuse("a closing bracket is expected");
        } else {
            node = comparison();
        }
        --depth_;
        return node;
    }

    std::size_t comparison() {
        const auto node = one_comparison();
        skip();
        if (at_ < text_.size() && std::string_view("<>=!").find(text_[at_]) != std::string_view::npos)
            refuse("and with another comparison (0.2 < x and x < 0.5) is expected");
        return node;
    }

    std::size_t one_comparison() {
        if (++comparisons_ > most_comparisons) refuse(fmt::format("no more than {} comparisons", most_comparisons));
        if (const auto number_first = number()) {
            const std::string stated = unit();
            const auto kind = sign();
            const Node compared = value();
            return add({.kind = mirrored(kind),
                        .name = compared.name,
                        .over = compared.over,
                        .number = in_unit_of(compared, *number_first, stated)});
        }
        const Node compared = value();
        const auto bound = [&](Kind kind) {
            return add({.kind = kind, .name = compared.name, .over = compared.over, .number = number_for(compared)});
        };
        if (take("between")) {
            const auto lower = bound(Kind::at_least);
            if (!take("and")) refuse("and is expected");
            const auto upper = bound(Kind::at_most);
            const auto value_of = [this](std::size_t node) { return condition_.nodes_[node].number; };
            if (value_of(lower) > value_of(upper)) refuse("no value is between them: the lower one comes first");
            return add({.kind = Kind::all, .first = lower, .second = upper});
        }
        return bound(sign());
    }

    /// A name, or a ratio of two.
    Node value() {
        Node compared{.name = name()};
        if (take_sign('/')) compared.over = name();
        return compared;
    }

    /// The unit behind a number: up to a comparison, a bracket or a word that joins conditions.
    std::string unit() {
        std::string unit;
        while (true) {
            skip();
            const auto rest = text_.substr(at_);
            const auto end = std::min(rest.find_first_of(" \t\n()<>=!"), rest.size());
            std::string part(rest.substr(0, end));
            const std::string small = campaign::small_letters(part);
            const bool joins = small == "and" || small == "or" || small == "not";
            if (part.empty() || joins || std::ranges::find(names_, part) != names_.end()) return unit;
            unit += (unit.empty() ? "" : " ") + part;
            at_ += end;
        }
    }

    double in_unit_of(const Node& compared, double number, const std::string& stated) {
        if (stated.empty()) return number;
        if (compared.over || compared.name >= units_.size())
            refuse(fmt::format("a number without the unit '{}' is expected", stated));
        const auto& wanted = units_[compared.name];
        const auto converted =
            campaign::in_si(fmt::format("{} {}", shortest_text(number), stated), wanted.empty() ? "1" : wanted);
        if (const auto* why = std::get_if<std::string>(&converted))
            throw campaign::input_error(
                "--where", text_,
                fmt::format("'{}' is in {}, and {}", names_[compared.name], wanted.empty() ? "1" : wanted, *why));
        return std::get<double>(converted);
    }

    double number_for(const Node& compared) {
        const double number = wanted_number();
        const std::string stated = unit();
        return in_unit_of(compared, number, stated);
    }

    Kind sign() {
        if (take_sign('<')) return take_sign('=') ? Kind::at_most : Kind::below;
        if (take_sign('>')) return take_sign('=') ? Kind::at_least : Kind::above;
        refuse("<, <=, > or >= is expected");
    }

    static Kind mirrored(Kind kind) {
        switch (kind) {
            case Kind::below:
                return Kind::above;
            case Kind::at_most:
                return Kind::at_least;
            case Kind::above:
                return Kind::below;
            default:
                return Kind::at_most;
        }
    }

    std::size_t name() {
        const auto word = word_ahead();
        if (word.empty()) refuse("the name of an observable or a factor is expected");
        const auto found = std::ranges::find(names_, word);
        if (found == names_.end())
            refuse(fmt::format("'{}' is neither observable nor factor of the campaign", word),
                   campaign::nearest_word(word, names_));
        at_ += word.size();
        return static_cast<std::size_t>(found - names_.begin());
    }

    std::optional<double> number() {
        skip();
        const auto rest = text_.substr(at_);
        const std::size_t plus = rest.starts_with('+') ? 1 : 0;
        double value = 0;
        const auto [end, error] = std::from_chars(rest.data() + plus, rest.data() + rest.size(), value);
        const bool begins = !rest.empty() && std::isalpha(static_cast<unsigned char>(rest.front())) == 0;
        if (!begins || error != std::errc() || !std::isfinite(value)) return std::nullopt;
        at_ += static_cast<std::size_t>(end - rest.data());
        return value;
    }

    double wanted_number() {
        if (const auto value = number()) return *value;
        refuse("a number is expected");
    }

    std::string_view text_;
    std::span<const std::string> names_, units_;
    std::size_t at_ = 0;
    int depth_ = 0, comparisons_ = 0;
    Condition condition_;
};

Condition Condition::read(std::string_view text, std::span<const std::string> names,
                          std::span<const std::string> units) {
    return ConditionReader(text, names, units).read();
}

std::optional<bool> Condition::decide(std::size_t index, std::span<const double> values) const {
    const auto& node = nodes_[index];
    switch (node.kind) {
        case Kind::none: {
            const auto inner = decide(node.first, values);
            return inner ? std::optional(!*inner) : std::nullopt;
        }
        case Kind::all:
        case Kind::any: {
            const bool decisive = node.kind == Kind::any;
            const auto first = decide(node.first, values);
            if (first == decisive) return decisive;
            const auto second = decide(node.second, values);
            if (second == decisive) return decisive;
            return first && second ? std::optional(!decisive) : std::nullopt;
        }
        default:
            break;
    }
    const double value = node.over ? values[node.name] / values[*node.over] : values[node.name];
    if (std::isnan(value)) return std::nullopt;
    if (node.kind == Kind::below) return value < node.number;
    if (node.kind == Kind::at_most) return value <= node.number;
    if (node.kind == Kind::above) return value > node.number;
    return value >= node.number;
}

bool Condition::holds(std::span<const double> values) const {
    return decide(nodes_.size() - 1, values).value_or(false);
}

std::vector<std::size_t> Condition::compared() const {
    std::vector<std::size_t> names;
    for (const auto& node : nodes_) {
        const bool comparison = node.kind != Kind::all && node.kind != Kind::any && node.kind != Kind::none;
        if (!comparison) continue;
        for (const auto name : {node.name, node.over.value_or(node.name)})
            if (std::ranges::find(names, name) == names.end()) names.push_back(name);
    }
    return names;
}

void Condition::collect(std::size_t index, bool negated, std::size_t name, bool& from_below, bool& from_above) const {
    const auto& node = nodes_[index];
    if (node.kind == Kind::none) return collect(node.first, !negated, name, from_below, from_above);
    if (node.kind == Kind::all || node.kind == Kind::any) {
        collect(node.first, negated, name, from_below, from_above);
        collect(node.second, negated, name, from_below, from_above);
        return;
    }
    if (node.over == name) from_below = from_above = true;  // by the sign of the other
    if (node.name != name) return;
    const bool lower_bound = node.kind == Kind::above || node.kind == Kind::at_least;
    (lower_bound != negated ? from_below : from_above) = true;
}

int Condition::direction(std::size_t name) const {
    bool from_below = false, from_above = false;
    collect(nodes_.size() - 1, false, name, from_below, from_above);
    return static_cast<int>(from_below) - static_cast<int>(from_above);
}

}  // namespace grainsweep::study
