// "factors" and "fixed": varied parameters and fixed parameters.
#include "sweep/campaign/expressions.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/installed_machines.hpp"
#include "sweep/campaign/joint_column.hpp"
#include "sweep/campaign/machine.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/campaign/quantity.hpp"
#include "sweep/campaign/sections.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

namespace grainsweep::campaign {

namespace {

Between read_between(const Section& factor, const ParameterSpec& parameter, const std::filesystem::path& folder) {
    const Cursor place = factor.at("between");
    if (!place.json().is_array())
        place.refuse("must be [low, high]; what is the same in every case goes into \"fixed\"");
    const auto ends = place.elements();
    if (ends.size() != 2) place.refuse("must be [low, high]");
    Between range;
    range.low = std::get<double>(coerced(read_value(ends[0], parameter, folder), Value{0.0}));
    range.high = std::get<double>(coerced(read_value(ends[1], parameter, folder), Value{0.0}));
    if (!(range.low < range.high)) place.refuse("low must be below high");
    if (!std::isfinite(range.high - range.low)) place.refuse("the range must be finite in double precision");
    range.scale = factor.word("scale", "linear") == "log" ? Scale::log : Scale::linear;
    if (range.scale == Scale::log && range.low <= 0) place.refuse("a logarithmic range must lie above 0");
    if (range.scale == Scale::log && !std::isfinite(range.high / range.low)) {
        place.refuse("the ratio of a logarithmic range must be finite in double precision");
    }
    return range;
}

Levels read_levels(const Section& factor, const ParameterSpec& parameter, const std::filesystem::path& folder) {
    const Cursor place = factor.at("levels");
    Levels levels;
    std::set<std::string> seen;
    for (const auto& element : place.elements()) {
        levels.values.push_back(read_value(element, parameter, folder));
        if (!seen.insert(identity_text(levels.values.back())).second) element.refuse("this level is there twice");
    }
    if (levels.values.empty()) place.refuse("a factor needs at least one level");
    return levels;
}

/// Returns the one key that defines the values of the factor.
std::string_view range_key(const Section& section) {
    std::vector<std::string_view> given;
    for (const auto key : range_keys)
        if (section.find(key)) given.push_back(key);
    if (given.size() == 1) return given.front();
    throw input_error(section.place().path(), given.empty() ? "none" : fmt::format("{}", fmt::join(given, " and ")),
                      fmt::format("a factor has one of {}", in_words(range_keys)));
}

void check_key(const Section& section, std::string_view key, const ParameterSpec& parameter) {
    const Cursor place = section.at(key);
    if (const auto scale = section.find("scale"); scale && key != "between")
        scale->refuse(key == "levels" ? "levels have no scale; it belongs to \"between\""
                                      : "a distribution has no scale; it belongs to \"between\"");
    if (key == "levels") return;
    if (std::holds_alternative<std::string>(parameter.default_value))
        place.refuse(fmt::format("the values of '{}' are words; vary it by \"levels\"", parameter.name));
    if (!std::holds_alternative<std::int64_t>(parameter.default_value)) return;
    if (key != "between") place.refuse(fmt::format("'{}' is a whole number; vary it by \"levels\"", parameter.name));
    if (!section.find("whole") && !section.find("step"))
        place.refuse(
            fmt::format("'{}' is a whole number: add \"whole\": true, or vary it by \"levels\"", parameter.name));
}

/// Whether a text is meant as a number and its unit, although it is not one.
bool resembles_quantity(std::string_view text) {
    const bool begins = text.find_first_of("0123456789.") == text.find_first_not_of(" +-");
    return begins && !text.empty() && text.find_first_of("()+*<>=&|,") == std::string_view::npos;
}

/// Returns the expression that defines a fixed number; empty: it is given as a value.
std::optional<Formula> read_formula(const Cursor& place, const ParameterSpec& parameter, const SceneInfo& scene) {
    if (!place.json().is_string() || std::holds_alternative<std::string>(parameter.default_value)) return std::nullopt;
    const auto& text = place.json().get_ref<const std::string&>();
    if (std::holds_alternative<double>(in_si(text, parameter.unit))) return std::nullopt;
    auto formula = parse_expression(text, scene);
    if (auto* sound = std::get_if<Formula>(&formula)) return std::move(*sound);
    if (resembles_quantity(text)) return std::nullopt;
    if (const auto pointed = with_decimal_point(text); !pointed.empty())
        place.refuse(fmt::format("the decimal sign is a point: '{}'", pointed));
    place.refuse(fmt::format("{}, or an expression of other parameters: {}", rule_of(parameter),
                             std::get<std::string>(formula)));
}

std::string no_parameter(const SceneInfo& scene) {
    const auto named = scene_named(scene.shown());
    const bool own = is_machine(scene.name) && (named == nullptr || named->name != scene.name);
    return fmt::format("{} '{}' has no parameter of this name (grainsweep {} lists them)", own ? "machine" : "scene",
                       scene.shown(), own ? "machines FILE" : "scenes " + scene.shown());
}

}  // namespace

const ParameterSpec& read_parameter(const Cursor& name, const SceneInfo& scene) {
    const auto* parameter = name.json().is_string() ? scene.find_parameter(name.json().get<std::string>()) : nullptr;
    if (parameter != nullptr) return *parameter;
    name.refuse(no_parameter(scene), name.json().is_string()
                                         ? nearest_word(name.json().get<std::string>(), names_of(scene.parameters))
                                         : "");
}

Factor read_factor(const Section& section, const ParameterSpec& parameter, const std::filesystem::path& folder) {
    (void)section.word("role", "control");  // read again from the stored file: remarks_in
    const auto key = range_key(section);
    check_key(section, key, parameter);
    Factor factor{.name = parameter.name, .range = {}, .unit = parameter.unit};
    if (key == "between") {
        factor.range = read_between(section, parameter, folder);
    } else if (key == "levels") {
        factor.range = read_levels(section, parameter, folder);
    } else if (key != "sample") {
        std::visit([&](auto&& range) { factor.range = std::move(range); },
                   read_distribution(section, key, parameter, folder));
    }
    if (key == "levels" || key == "sample")
        refuse_steps(section, fmt::format("the values of a factor with \"{}\" are taken as they are", key));
    else
        factor.step = read_step(section, parameter, factor);
    read_ties(section, factor);
    return factor;
}

std::vector<Factor> read_factors(const Cursor& place, const SceneInfo& scene, const std::filesystem::path& folder) {
    std::vector<Factor> factors;
    std::vector<NamedColumn> sampled;
    for (const auto& element : place.elements()) {
        const Section section(element, factor_keys);
        const auto& parameter = read_parameter(section.at("name"), scene);
        if (std::ranges::find(factors, parameter.name, &Factor::name) != factors.end()) {
            section.at("name").refuse("this factor is there twice");
        }
        if (section.find("sample")) sampled.push_back(read_named_column(section, factors.size(), parameter, folder));
        factors.push_back(read_factor(section, parameter, folder));
    }
    read_samples(sampled, factors, scene, folder);
    for (std::size_t j = 0; j < factors.size(); ++j)
        if (!factors[j].when.empty() && column_of(factors[j].distribution()) != nullptr)
            place[j]["when"].refuse("factors that take rows of one sample count at every point: leave out 'when'");
    if (factors.empty()) place.refuse("a campaign varies at least one factor");
    return factors;
}

void read_fixed(const Cursor& place, ParameterSpace& space, const std::filesystem::path& folder) {
    for (const auto& [key, here] : place.members("must be an object of parameter names and values")) {
        const auto* parameter = space.scene->find_parameter(key);
        if (parameter == nullptr) {
            throw input_error(here.path(), "", no_parameter(*space.scene),
                              nearest_word(key, names_of(space.scene->parameters)));
        }
        if (std::ranges::find(space.factors, key, &Factor::name) != space.factors.end()) {
            here.refuse(fmt::format("'{}' is also a factor; it is either varied or fixed", key));
        }
        auto formula = read_formula(here, *parameter, *space.scene);
        if (!formula) {
            space.fixed[key] = read_value(here, *parameter, folder);
            continue;
        }
        space.expressions.push_back(
            {key, std::move(*formula), std::holds_alternative<std::int64_t>(parameter->default_value)});
        if (is_program(space.scene->name)) refuse_mixed_units(space.expressions.back(), *space.scene);
        refuse_degrees(space.expressions.back(), *space.scene);
    }
    space.expressions = in_order(std::move(space.expressions));
}

}  // namespace grainsweep::campaign
