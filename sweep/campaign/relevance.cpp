#include "sweep/campaign/relevance.hpp"

#include "sweep/campaign/cursor.hpp"
#include "sweep/campaign/expressions.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace grainsweep::campaign {

namespace {

bool is_zero(const Value& value) {
    return coerced(value, Value{0.0}) == Value{0.0};
}

bool satisfies(const Relevance& condition, const Value& value) {
    switch (condition.condition) {
        case Relevance::Condition::zero:
            return is_zero(value);
        case Relevance::Condition::nonzero:
            return !is_zero(value);
        case Relevance::Condition::is_word:
            return std::ranges::find(condition.words, to_text(value)) != condition.words.end();
        case Relevance::Condition::is_file:
            return std::holds_alternative<std::string>(value) && file_word(std::get<std::string>(value)).has_value();
    }
    return true;
}

bool can_satisfy(const Relevance& condition, const Factor& factor) {
    if (const auto* levels = std::get_if<Levels>(&factor.range)) {
        return std::ranges::any_of(levels->values, [&](const Value& value) { return satisfies(condition, value); });
    }
    const auto value = [&](double u) { return factor.number(u); };
    if (condition.condition == Relevance::Condition::zero) return value(0) <= 0 && value(1) >= 0;
    return condition.condition == Relevance::Condition::nonzero;
}

std::string demand_of(const Relevance& condition) {
    switch (condition.condition) {
        case Relevance::Condition::zero:
            return "zero";
        case Relevance::Condition::nonzero:
            return "not zero";
        case Relevance::Condition::is_word:
            return in_words(condition.words);
        case Relevance::Condition::is_file:
            return "a file";
    }
    return {};
}

const Factor* find_factor(const ParameterSpace& space, std::string_view name) {
    const auto found = std::ranges::find(space.factors, name, &Factor::name);
    return found == space.factors.end() ? nullptr : &*found;
}

auto find_expression(const ParameterSpace& space, std::string_view name) {
    return std::ranges::find(space.expressions, name, &Expression::name);
}

}  // namespace

std::optional<std::string> no_effect(const ParameterSpace& space, const ParameterSpec& parameter) {
    for (const auto& condition : parameter.relevant_if) {
        const auto* other = space.scene->find_parameter(condition.other);
        if (other == nullptr) continue;
        if (const auto* factor = find_factor(space, condition.other)) {
            if (can_satisfy(condition, *factor)) continue;
            return fmt::format("'{}' has no effect here: it matters only where '{}' is {}, which this factor never is",
                               parameter.name, condition.other, demand_of(condition));
        }
        if (find_expression(space, condition.other) != space.expressions.end())
            continue;  // its value differs from case to case
        const auto fixed = space.fixed.find(condition.other);
        const Value& value = fixed == space.fixed.end() ? other->default_value : fixed->second;
        if (satisfies(condition, value)) continue;
        return fmt::format("'{}' has no effect here: it matters only where '{}' is {}, and that is {}{}",
                           parameter.name, condition.other, demand_of(condition), identity_text(value),
                           fixed == space.fixed.end() ? " by default" : "");
    }
    return std::nullopt;
}

bool is_left_open(const ParameterSpace& space, const Inputs& stated, const std::string& name) {
    const auto* parameter = space.scene->find_parameter(name);
    return parameter != nullptr && !no_effect(space, *parameter) && find_factor(space, name) == nullptr &&
           find_expression(space, name) == space.expressions.end() && !stated.contains(name);
}

void resolve_accuracy(ParameterSpace& space, std::string_view accuracy) {
    const auto setting = space.scene->accuracy.find(accuracy);
    if (setting == space.scene->accuracy.end()) return;
    const Inputs given = fixed_as_stated(space);
    for (const auto& [name, value] : setting->second) {
        if (!given.contains(name) && find_factor(space, name) == nullptr) space.fixed[name] = value;
    }
    // Only now, with all of them in place, is it known which matter.
    for (const auto& [name, value] : setting->second) {
        const auto* parameter = space.scene->find_parameter(name);
        const bool ours = !given.contains(name) && find_factor(space, name) == nullptr;
        if (ours && parameter != nullptr && no_effect(space, *parameter)) space.fixed.erase(name);
    }
}

void hold(ParameterSpace& space, std::string_view parameter, const Value& value, std::string_view accuracy) {
    std::erase_if(space.factors, [&](const Factor& factor) { return factor.name == parameter; });
    std::erase_if(space.expressions, [&](const Expression& expression) { return expression.name == parameter; });
    std::erase_if(space.when, [&](const WhenClause& clause) { return clause.factor == parameter; });
    space.fixed[std::string(parameter)] = value;
    const auto setting = space.scene->accuracy.find(accuracy);
    if (setting == space.scene->accuracy.end()) return;
    for (const auto& [name, standard] : setting->second) {
        const auto held = space.fixed.find(name);
        const auto* spec = space.scene->find_parameter(name);
        const bool from_setting = name != parameter && held != space.fixed.end() && held->second == standard;
        if (from_setting && spec != nullptr && no_effect(space, *spec)) space.fixed.erase(held);
    }
}

}  // namespace grainsweep::campaign
