#include "sweep/campaign/expressions.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/campaign/quantity.hpp"
#include "sweep/campaign/sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

namespace grainsweep::campaign {

namespace {

double as_number(const Value& value) {
    const Value real = coerced(value, Value{0.0});
    return std::get<double>(real);
}

[[noreturn]] void refuse_expression(const Expression& expression, std::string_view rule) {
    throw input_error(path_of("$.fixed", expression.name), fmt::format("\"{}\"", expression.formula.text()), rule);
}

/// Whether a parameter of a program is declared to be whole.
bool is_whole_of_program(std::string_view scene, const std::string& name) {
    const auto program = known_program(scene);
    if (program == nullptr) return false;
    const auto parameter = std::ranges::find(program->parameters, name, &ProgramParameter::name);
    return parameter != program->parameters.end() && parameter->whole;
}

/// Refuses expressions that all wait for one another, at one of a circle.
[[noreturn]] void refuse_circle(const std::vector<Expression>& expressions) {
    const auto named = [&](const std::string& name) { return std::ranges::find(expressions, name, &Expression::name); };
    std::vector<std::string> path;
    std::string next = expressions.front().name;
    while (std::ranges::find(path, next) == path.end()) {
        path.push_back(next);
        next = *std::ranges::find_if(named(next)->formula.names(),
                                     [&](const auto& name) { return named(name) != expressions.end(); });
    }
    std::string circle = next;
    for (auto step = std::ranges::find(path, next) + 1; step != path.end(); ++step) circle += " needs " + *step;
    refuse_expression(*named(next), fmt::format("an expression cannot need itself: {} needs {}", circle, next));
}

}  // namespace

std::variant<Formula, std::string> parse_expression(std::string_view text, const SceneInfo& scene) {
    std::vector<std::string_view> numbers;
    for (const auto& parameter : scene.parameters)
        if (!std::holds_alternative<std::string>(parameter.default_value)) numbers.push_back(parameter.name);
    auto parsed = Formula::parse(text, numbers);
    auto* why = std::get_if<std::string>(&parsed);
    if (why == nullptr) return parsed;
    for (const auto& parameter : scene.parameters)
        if (std::holds_alternative<std::string>(parameter.default_value) &&
            why->starts_with(fmt::format("'{}' is no name", parameter.name)))
            *why += fmt::format("; the values of {} are words, and expressions are of numbers", parameter.name);
    return parsed;
}

std::vector<Expression> in_order(std::vector<Expression> expressions) {
    std::vector<Expression> ordered;
    while (!expressions.empty()) {
        const auto waits = [&](const std::string& name) {
            return std::ranges::find(expressions, name, &Expression::name) != expressions.end();
        };
        const auto ready = std::ranges::find_if(expressions, [&](const Expression& expression) {
            return std::ranges::none_of(expression.formula.names(), waits);
        });
        if (ready == expressions.end()) refuse_circle(expressions);
        ordered.push_back(std::move(*ready));
        expressions.erase(ready);
    }
    return ordered;
}

void refuse_mixed_units(const Expression& expression, const SceneInfo& scene) {
    auto names = expression.formula.names();
    names.push_back(expression.name);
    std::set<std::string> units;
    std::string listed;
    for (const auto& name : names) {
        const auto& unit = scene.find_parameter(name)->unit;
        if (unit.empty() || unit == "1") continue;
        units.insert(unit);
        listed += fmt::format("{}{} is in {}", listed.empty() ? "" : ", ", name, unit);
    }
    if (units.size() < 2 || std::ranges::all_of(units, is_si_unit)) return;
    refuse_expression(expression, fmt::format("an expression takes the numbers as they are, and {}: state one unit for "
                                              "all in program.parameters, or SI units",
                                              listed));
}

void refuse_degrees(const Expression& expression, const SceneInfo& scene) {
    const auto& text = expression.formula.text();
    const auto has = [&](std::string_view part) { return text.find(part) != std::string::npos; };
    const auto any_of = [&](auto... parts) { return (has(parts) || ...); };
    const bool has_pi = !names_in(text, [](std::string_view name) { return name == "pi"; }).empty();
    if (!any_of("sin(", "cos(", "tan(", "atan2(") || has_pi || any_of("180", "0.0174", "57.29")) return;
    auto names = expression.formula.names();
    names.push_back(expression.name);
    for (const auto& name : names) {
        const auto radians = in_si(fmt::format("1 {}", scene.find_parameter(name)->unit), "rad");
        const auto* factor = std::get_if<double>(&radians);
        if (factor == nullptr || *factor == 1) continue;
        refuse_expression(expression, fmt::format("sin, cos, tan and atan2 are of radians, and {0} is in {1}: {2}",
                                                  name, scene.find_parameter(name)->unit,
                                                  name == expression.name ? "multiply the angle by 180/pi"
                                                                          : fmt::format("write {}*pi/180", name)));
    }
}

void evaluate_expressions(std::span<const Expression> expressions, Inputs& inputs) {
    for (const auto& [name, formula, whole] : expressions) {
        const double x = formula([&](std::string_view other) { return as_number(inputs.find(other)->second); });
        Value kind = 0.0;
        if (whole) kind = std::int64_t{0};
        inputs.find(name)->second = coerced(Value{x}, kind);
    }
}

void check_expressions(const ParameterSpace& space, const Inputs& inputs) {
    for (const auto& expression : space.expressions) {
        const auto& parameter = *space.scene->find_parameter(expression.name);
        const Value& value = inputs.find(expression.name)->second;
        const bool fits = value.index() == parameter.default_value.index() && std::isfinite(as_number(value)) &&
                          std::get<Interval>(parameter.bounds).contains(as_number(value));
        const bool counts = is_whole_of_program(space.scene->name, expression.name);
        if (fits && !(counts && as_number(value) != std::floor(as_number(value)))) continue;
        std::string where;
        for (const auto& name : expression.formula.names())
            where +=
                fmt::format("{}{} = {}", where.empty() ? " where " : ", ", name, to_text(inputs.find(name)->second));
        refuse_expression(
            expression,
            fmt::format("{}, and it is {}{}",
                        fits ? fmt::format("'{}' must be a whole number", parameter.name) : rule_of(parameter),
                        std::isnan(as_number(value)) ? "not a number" : to_text(value), where));
    }
}

Inputs fixed_as_stated(const ParameterSpace& space) {
    Inputs stated = space.fixed;
    for (const auto& expression : space.expressions) stated[expression.name] = expression.formula.text();
    return stated;
}

std::vector<Expression> expressions_of(const Identity& identity, const SceneInfo& scene) {
    std::vector<Expression> expressions;
    for (const auto& [name, value] : identity.fixed) {
        const auto* text = std::get_if<std::string>(&value);
        const auto* parameter = scene.find_parameter(name);
        if (text == nullptr || parameter == nullptr || std::holds_alternative<std::string>(parameter->default_value))
            continue;
        auto formula = parse_expression(*text, scene);
        if (auto* sound = std::get_if<Formula>(&formula))
            expressions.push_back(
                {name, std::move(*sound), std::holds_alternative<std::int64_t>(parameter->default_value)});
    }
    return in_order(std::move(expressions));
}

}  // namespace grainsweep::campaign
