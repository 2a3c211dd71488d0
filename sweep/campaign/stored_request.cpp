#include "sweep/campaign/stored_request.hpp"

#include "solver/plain_text.hpp"
#include "solver/scenes/scene.hpp"
#include "sweep/campaign/expressions.hpp"
#include "sweep/campaign/sections.hpp"

#include <charconv>
#include <sstream>
#include <string>
#include <utility>

namespace grainsweep::campaign {
namespace {

template <class Number>
Number stored_number(const std::string& text) {
    Number number{};
    std::from_chars(text.data(), text.data() + text.size(), number);
    return number;
}

designs::OptionValue value_of(const designs::OptionSpec& option, const std::string& text) {
    using Kind = designs::OptionSpec::Kind;
    switch (option.kind) {
        case Kind::count:
            return stored_number<std::int64_t>(text);
        case Kind::number:
            return stored_number<double>(text);
        case Kind::counts: {
            std::istringstream stream(text);
            std::vector<std::int64_t> counts;
            for (std::int64_t count = 0; stream >> count;) counts.push_back(count);
            if (counts.size() == 1) return counts.front();
            return counts;
        }
        case Kind::rows:
            return designs::Rows{};
        case Kind::word:
        case Kind::factor:
        case Kind::observable:
            break;
    }
    return text;
}

/// Returns a stored factor; levels as text.
Factor factor_of(const StatedFactor& stated) {
    Factor factor{stated.name,  Levels{{stated.levels.begin(), stated.levels.end()}},
                  stated.step,  stated.share,
                  stated.group, stated.when};
    if (stated.between) factor.range = *stated.between;
    if (stated.distribution) factor.range = *stated.distribution;
    return factor;
}

}  // namespace

Inputs fixed_values(const Identity& identity, const SceneInfo& scene) {
    Inputs values;
    std::istringstream lines(identity.fixed);
    for (std::string line; std::getline(lines, line);) {
        const auto sign = line.find(" = ");
        if (sign == std::string::npos) continue;
        const auto name = line.substr(0, sign), text = line.substr(sign + 3);
        const auto* parameter = scene.find_parameter(name);
        if (parameter == nullptr) continue;
        if (std::holds_alternative<std::string>(parameter->default_value)) {
            values[name] = text;
        } else if (const auto number = any_number_in(text)) {
            values[name] = coerced(Value{*number}, parameter->default_value);
        }
    }
    return values;
}

std::vector<Factor> factors_asked(const Identity& identity) {
    std::vector<Factor> factors;
    for (const auto& stated : factors_of(identity)) factors.push_back(factor_of(stated));
    return factors;
}

std::optional<ParameterSpace> space_of(const Identity& identity) {
    const auto scene = find_scene(identity.scene);
    if (scene == nullptr) return std::nullopt;
    auto factors = factors_asked(identity);
    for (auto& factor : factors) {
        auto* levels = std::get_if<Levels>(&factor.range);
        const auto* parameter = scene->find_parameter(factor.name);
        if (parameter == nullptr) return std::nullopt;
        if (levels == nullptr || std::holds_alternative<std::string>(parameter->default_value)) continue;
        for (auto& value : levels->values)
            if (const auto number = any_number_in(std::get<std::string>(value))) value = *number;
    }
    return ParameterSpace{.scene = scene,
                          .factors = std::move(factors),
                          .fixed = fixed_values(identity, *scene),
                          .expressions = expressions_of(identity, *scene)};
}

designs::DesignRequest request_of(const Identity& identity) {
    const auto& design = designs::design_named(identity.design);
    designs::DesignRequest request;
    request.seed = identity.seed;
    request.groups = groups_of(factors_asked(identity));
    for (const auto& stated : factors_of(identity)) {
        request.levels.push_back(stated.levels.size());
        request.factors.push_back(range_of(factor_of(stated)));
    }
    const auto stated = options_in(identity);
    if (const auto together = stated.find("together"); together != stated.end())
        for (const auto& factor : factors_in(together->second)) request.shared.push_back(range_of(factor_of(factor)));
    for (const auto& option : design.options) {
        const auto found = stated.find(option.name);
        if (found != stated.end()) {
            request.options[option.name] = value_of(option, found->second);
        } else if (option.default_value) {
            request.options[option.name] = *option.default_value;
        }
    }
    return request;
}

}  // namespace grainsweep::campaign
