#include "sweep/campaign/campaign.hpp"
#include "sweep/campaign/expressions.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/joint_column.hpp"
#include "sweep/campaign/simplex.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace grainsweep::campaign {

namespace {

/// -0 and 0 are one question.
double unsigned_zero(double x) {
    return x == 0 ? 0 : x;
}

}  // namespace

Value value_at(std::span<const Factor> factors, std::size_t j, std::span<const double> u) {
    const auto joint =
        joint_value(factors.size(), j, u, [&](std::size_t k) { return column_of(factors[k].distribution()); });
    return joint ? Value{*joint} : factors[j].value(u[j]);
}

namespace {

std::string group_name(const Factor& factor) {
    if (factor.share) return std::string(group_of_shares);
    return factor.group.empty() ? factor.name : factor.group;
}

}  // namespace

std::vector<std::string> group_names(std::span<const Factor> factors) {
    std::vector<std::string> names;
    for (const auto& factor : factors)
        if (const auto name = group_name(factor); std::ranges::find(names, name) == names.end()) names.push_back(name);
    return names;
}

std::vector<std::size_t> groups_of(std::span<const Factor> factors) {
    const auto names = group_names(factors);
    std::vector<std::size_t> groups;
    for (const auto& factor : factors)
        groups.push_back(static_cast<std::size_t>(std::ranges::find(names, group_name(factor)) - names.begin()));
    return groups;
}

bool repeats_weigh(std::span<const Factor> factors) {
    return std::ranges::any_of(factors, [](const Factor& factor) {
        const auto* range = std::get_if<Between>(&factor.range);
        const auto* distribution = std::get_if<stats::Distribution>(&factor.range);
        const bool sampled =
            distribution != nullptr && std::holds_alternative<stats::SampleColumn>(distribution->form());
        return sampled || !factor.when.empty() || (factor.step && !(range != nullptr && range->scale == Scale::linear));
    });
}

Value coerced(const Value& value, const Value& like) {
    if (const auto* whole = std::get_if<std::int64_t>(&value); whole != nullptr && like.index() == 0) {
        return unsigned_zero(static_cast<double>(*whole));
    }
    if (const auto* real = std::get_if<double>(&value)) {
        if (like.index() == 1 && *real == std::floor(*real) && std::abs(*real) < 0x1p63) {
            return static_cast<std::int64_t>(*real);
        }
        return unsigned_zero(*real);
    }
    return value;
}

const Value& default_of(const SceneInfo& scene, std::string_view parameter) {
    return scene.find_parameter(parameter)->default_value;
}

Inputs ParameterSpace::at(std::span<const double> u) const {
    assert(u.size() == factors.size());
    std::vector<double> coordinates(u.begin(), u.end());
    share_out(factors, coordinates);
    std::vector<Value> row;
    row.reserve(factors.size());
    for (std::size_t j = 0; j < factors.size(); ++j) row.push_back(value_at(factors, j, coordinates));
    return at(row);
}

Inputs ParameterSpace::at(std::span<const Value> row) const {
    assert(row.size() == factors.size());
    Inputs inputs = scene->defaults();
    const auto set = [&inputs](const std::string& name, const Value& value) {
        Value& slot = inputs.at(name);
        slot = coerced(value, slot);
    };
    for (const auto& [name, value] : fixed) set(name, value);
    for (std::size_t j = 0; j < factors.size(); ++j) set(factors[j].name, row[j]);
    for (const auto& clause : when)
        if (!clause.holds(inputs)) set(clause.factor, default_of(*scene, clause.factor));
    evaluate_expressions(expressions, inputs);
    return inputs;
}

std::vector<std::string> filter_names(const Campaign& campaign) {
    const auto names = names_of(campaign.scene().parameters);
    return {names.begin(), names.end()};
}

}  // namespace grainsweep::campaign
