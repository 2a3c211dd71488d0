#include "sweep/cli/settings.hpp"

#include "sweep/campaign/csv_table.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/quantity.hpp"
#include "sweep/files/whole_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <variant>

namespace grainsweep::cli {
namespace {

using study::ModelFactor;
using study::Setting;

std::vector<std::string> names_of(std::span<const ModelFactor> factors) {
    std::vector<std::string> names;
    for (const auto& factor : factors) names.push_back(factor.name);
    return names;
}

std::size_t factor_named(std::string_view name, std::span<const ModelFactor> factors, std::string_view where) {
    const auto found = std::ranges::find(factors, name, &ModelFactor::name);
    if (found != factors.end()) return static_cast<std::size_t>(found - factors.begin());
    const auto names = names_of(factors);
    throw campaign::input_error(
        where, fmt::format("'{}'", name),
        fmt::format("is not a factor of the campaign; its factors are {}", campaign::listed(names)),
        campaign::nearest_word(name, names));
}

double value_of(const ModelFactor& factor, const std::string& text, std::string_view where) {
    if (factor.is_word()) {
        const auto found = std::ranges::find(factor.words, text);
        if (found != factor.words.end()) return static_cast<double>(found - factor.words.begin());
        throw campaign::input_error(where, fmt::format("'{}'", text),
                                    fmt::format("the levels of {} are {}", factor.name, campaign::listed(factor.words)),
                                    campaign::nearest_word(text, factor.words));
    }
    const auto number = campaign::in_si(text, factor.unit);
    if (const auto* value = std::get_if<double>(&number)) return *value;
    throw campaign::input_error(
        where, fmt::format("'{}'", text),
        fmt::format("{} takes a number{}{}: {}", factor.name, factor.unit.empty() || factor.unit == "1" ? "" : " in ",
                    factor.unit == "1" ? "" : factor.unit, std::get<std::string>(number)));
}

void require_all(std::span<const ModelFactor> factors, const std::vector<std::optional<double>>& values,
                 std::string_view where) {
    std::vector<std::string> missing;
    for (std::size_t j = 0; j < factors.size(); ++j)
        if (!values[j]) missing.push_back(factors[j].name);
    if (missing.empty()) return;
    throw campaign::input_error(where, "",
                                fmt::format("a setting needs every factor; {} {} missing", campaign::listed(missing),
                                            missing.size() == 1 ? "is" : "are"));
}

/// Puts defaults in the place of factors that do not count, given or not.
Setting complete(std::span<const ModelFactor> factors, std::vector<std::optional<double>> values,
                 std::string_view where) {
    Setting setting;
    for (std::size_t j = 0; j < factors.size(); ++j) setting.push_back(values[j].value_or(factors[j].standard));
    study::fold(factors, setting);
    for (std::size_t j = 0; j < factors.size(); ++j)
        if (factors[j].counts && !factors[j].counts(setting)) values[j] = setting[j];
    require_all(factors, values, where);
    return setting;
}

constexpr std::uintmax_t largest_file = 256ULL << 20U;

std::string text_of(const std::filesystem::path& file) {
    std::error_code none;
    if (!std::filesystem::is_regular_file(file, none))
        throw campaign::input_error("--points", file.string(), "there is no such file");
    if (std::filesystem::file_size(file, none) > largest_file)
        throw campaign::input_error("--points", file.string(), "the file must have at most 256 MiB");
    std::string text = files::whole_file(file, none);
    if (none)
        throw campaign::input_error("--points", file.string(),
                                    fmt::format("the file cannot be read: {}", none.message()));
    return text;
}

}  // namespace

namespace {

/// The values of NAME=VALUE after an option, by factor.
std::vector<std::optional<double>> assigned(std::span<const ModelFactor> factors,
                                            std::span<const std::string> assignments, const std::string& option) {
    std::vector<std::optional<double>> values(factors.size());
    for (const auto& assignment : assignments) {
        const auto equals = assignment.find('=');
        if (equals == std::string::npos) throw campaign::input_error(option, assignment, "must be NAME=VALUE");
        const std::string name = assignment.substr(0, equals), where = option + " " + name;
        const auto j = factor_named(name, factors, option);
        if (values[j]) throw campaign::input_error(where, "", "this factor is given twice");
        values[j] = value_of(factors[j], assignment.substr(equals + 1), where);
    }
    return values;
}

}  // namespace

Setting read_setting(std::span<const ModelFactor> factors, std::span<const std::string> assignments) {
    return complete(factors, assigned(factors, assignments, "--at"), "--at");
}

study::Held read_held(std::span<const ModelFactor> factors, std::span<const std::string> assignments) {
    const auto values = assigned(factors, assignments, "--hold");
    study::Held held;
    for (std::size_t j = 0; j < factors.size(); ++j) {
        if (!values[j]) continue;
        const auto& factor = factors[j];
        if (!factor.is_word() && !(*values[j] >= factor.low() && *values[j] <= factor.high()))
            throw campaign::input_error(
                "--hold " + factor.name, factor.text(*values[j]),
                fmt::format("is outside of {} to {}, where the campaign has cases", factor.low(), factor.high()));
        held.emplace_back(j, *values[j]);
    }
    return held;
}

void read_references(const study::ModelCases& cases, std::span<const std::string> assignments,
                     std::span<study::Objective> objectives) {
    for (const auto& assignment : assignments) {
        const auto equals = assignment.find('=');
        if (equals == std::string::npos) throw campaign::input_error("--reference", assignment, "must be NAME=VALUE");
        const std::string name = assignment.substr(0, equals), text = assignment.substr(equals + 1);
        const auto objective = std::ranges::find(objectives, name, &study::Objective::name);
        if (objective == objectives.end())
            throw campaign::input_error("--reference", name, "is neither of the two objectives");
        if (objective->reference) throw campaign::input_error("--reference", name, "this objective is given twice");
        const auto observable = std::ranges::find(cases.observables, name, &study::ResponseColumn::name);
        const auto factor = std::ranges::find(cases.factors, name, &ModelFactor::name);
        const auto unit = observable != cases.observables.end() ? observable->unit
                          : factor != cases.factors.end()       ? factor->unit
                                                                : std::string();
        const auto number = campaign::in_si(text, unit);
        const auto* value = std::get_if<double>(&number);
        if (value == nullptr || !std::isfinite(*value))
            throw campaign::input_error(
                "--reference " + name, fmt::format("'{}'", text),
                value == nullptr ? std::get<std::string>(number) : std::string("must be a finite number"));
        objective->reference = *value;
    }
}

std::vector<Setting> read_settings_file(const std::filesystem::path& file, std::span<const ModelFactor> factors) {
    const std::string text = text_of(file), where = "--points " + file.string();
    campaign::CsvTable table(text, [&](const std::string& rule) { throw campaign::input_error(where, "", rule); });
    std::vector<std::size_t> columns;
    std::vector<std::optional<double>> named(factors.size());
    for (const auto& name : table.header()) {
        columns.push_back(factor_named(name, factors, where));
        named[columns.back()] = 0;
    }
    require_all(factors, named, where);
    std::vector<Setting> settings;
    while (const auto record = table.next()) {
        auto& setting = settings.emplace_back(factors.size());
        for (std::size_t k = 0; k < columns.size(); ++k) {
            const auto& factor = factors[columns[k]];
            setting[columns[k]] = value_of(
                factor, (*record)[k], fmt::format("{}, record {}, column '{}'", where, table.number(), factor.name));
        }
        study::fold(factors, setting);
    }
    if (settings.empty()) throw campaign::input_error(where, "", "it has no row below its header");
    return settings;
}

}  // namespace grainsweep::cli
