#include "sweep/campaign/stored_identity.hpp"

#include "solver/plain_text.hpp"
#include "solver/scenes/scene.hpp"
#include "sweep/campaign/cursor.hpp"
#include "sweep/campaign/expressions.hpp"
#include "sweep/campaign/json_text.hpp"
#include "sweep/campaign/sections.hpp"
#include "sweep/campaign/stated_distribution.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <sstream>
#include <utility>

namespace grainsweep::campaign {
namespace {

constexpr std::string_view level_separator = " | ", factor_separator = "; ", step_mark = " step ";
constexpr std::string_view group_mark = " group ", when_mark = " when ", equals = " = ";
constexpr std::string_view common_mark = "common_random_numbers = ";

std::string line_of(const Factor& factor) {
    const auto step = factor.step ? fmt::format("{}{}", step_mark, shortest(*factor.step)) : "";
    if (const auto* between = factor.between())
        return fmt::format("{} between {} {} {}{}{}", factor.name, shortest(between->low), shortest(between->high),
                           factor.log() ? "log" : "linear", step, factor.share ? " share" : "");
    if (const auto* distribution = factor.distribution())
        return fmt::format("{} {}{}", factor.name, stated_text(*distribution), step);
    std::vector<std::string> levels;
    for (const auto& value : factor.levels()->values) levels.push_back(identity_text(value));
    return fmt::format("{} levels {}", factor.name, fmt::join(levels, level_separator));
}

/// Returns the relations of a factor to others, as lines that follow the lines of all factors.
std::string ties_of(const Factor& factor) {
    std::string lines;
    if (!factor.group.empty()) lines += fmt::format("{}{} {}\n", group_mark, factor.name, factor.group);
    if (!factor.when.empty()) lines += fmt::format("{}{} {}\n", when_mark, factor.name, factor.when);
    return lines;
}

/// Splits a text at the first separator; the second part is empty without one.
std::pair<std::string, std::string> split_once(std::string_view text, std::string_view separator) {
    const auto at = std::min(text.find(separator), text.size());
    return {std::string(text.substr(0, at)), std::string(text.substr(std::min(at + separator.size(), text.size())))};
}

std::vector<std::string> split(std::string_view text, std::string_view separator) {
    std::vector<std::string> parts;
    for (auto at = text.find(separator); at != std::string_view::npos; at = text.find(separator)) {
        parts.emplace_back(text.substr(0, at));
        text.remove_prefix(at + separator.size());
    }
    parts.emplace_back(text);
    return parts;
}

double stored_number(std::string_view text) {
    return any_number_in(text).value_or(0);
}

/// Returns a number, unless a word is wanted or the text is none.
Value number_or_text(const std::string& text, bool word) {
    const auto number = word ? std::nullopt : number_in(text);
    return number ? Value{*number} : Value{text};
}

/// Columns of samples, which become distributions when all columns of each are known.
class Samples {
public:
    void add(std::size_t factor, StatedColumn column) {
        auto& members = samples_[column.sample];
        const auto place = std::ranges::upper_bound(members, column.column, {},
                                                    [](const Member& member) { return member.stated.column; });
        members.insert(place, {factor, std::move(column)});
    }
    /// Sets the factors to their columns; columns of one sample share its rows.
    void join(std::vector<Factor>& factors) && {
        for (auto& [hash, members] : samples_) {
            std::vector<std::vector<double>> columns;
            for (auto& member : members) columns.push_back(std::move(member.stated.values));
            const auto sample = std::make_shared<const stats::JointSample>(std::move(columns));
            for (std::size_t k = 0; k < members.size(); ++k)
                factors[members[k].factor].range = stats::Distribution(stats::SampleColumn{sample, k});
        }
    }

private:
    struct Member {
        std::size_t factor = 0;
        StatedColumn stated;
    };
    std::map<std::string, std::vector<Member>> samples_;
};

/// Adds the factor of a line. `scene`: has the types of levels; null: unknown.
void add_factor(std::vector<Factor>& factors, Samples& samples, std::string_view line, const SceneInfo* scene) {
    constexpr std::string_view levels = "levels ", between = "between ";
    const auto [name, stated] = split_once(line, " ");
    const auto* parameter = scene == nullptr ? nullptr : scene->find_parameter(name);
    Factor factor{.name = name, .range = Levels{}, .unit = parameter == nullptr ? "" : parameter->unit};
    if (stated.starts_with(levels)) {
        const auto texts = split(stated.substr(levels.size()), level_separator);
        const bool words = parameter != nullptr ? std::holds_alternative<std::string>(parameter->default_value)
                                                : numbers_in(texts).empty();
        for (const auto& text : texts) {
            const auto value = number_or_text(text, words);
            std::get<Levels>(factor.range)
                .values.push_back(parameter == nullptr ? value : coerced(value, parameter->default_value));
        }
    } else if (stated.starts_with(between)) {
        std::istringstream words(stated.substr(between.size()));
        std::string low, high, scale;
        words >> low >> high >> scale;
        factor.range = Between{stored_number(low), stored_number(high), scale == "log" ? Scale::log : Scale::linear};
        for (std::string word, number; words >> word;) {
            if (word == "share") factor.share = true;
            if (word == "step" && words >> number) factor.step = stored_number(number);
        }
    } else {
        const auto step = stated.rfind(step_mark);
        if (step != std::string::npos)
            factor.step = stored_number(std::string_view(stated).substr(step + step_mark.size()));
        auto found = distribution_in(std::string_view(stated).substr(0, step));
        if (auto* whole = std::get_if<stats::Distribution>(&found)) factor.range = std::move(*whole);
        if (auto* column = std::get_if<StatedColumn>(&found); column != nullptr && !column->values.empty())
            samples.add(factors.size(), std::move(*column));
    }
    factors.push_back(std::move(factor));
}

designs::OptionValue option_in(const designs::DesignInfo* design, std::string_view name, const std::string& text) {
    using Kind = Field::Kind;
    if (design == nullptr) return text;
    const auto option = std::ranges::find(design->options, name, &designs::OptionSpec::name);
    if (option == design->options.end()) return text;
    if (option->kind == Kind::whole) return static_cast<std::int64_t>(stored_number(text));
    if (option->kind == Kind::number) return stored_number(text);
    if (option->kind != Kind::value) return text;
    std::istringstream stream(text);
    std::vector<std::int64_t> counts;
    for (std::int64_t count = 0; stream >> count;) counts.push_back(count);
    if (counts.size() == 1) return counts.front();
    return counts;
}

Json resolved_json(const Value& value) {
    return std::visit([](const auto& plain) { return Json(plain); }, value);
}

Json resolved_json(const designs::OptionValue& value) {
    if (const auto* word = std::get_if<std::string>(&value)) return *word;
    if (const auto* count = std::get_if<std::int64_t>(&value)) return *count;
    if (const auto* number = std::get_if<double>(&value)) return *number;
    return std::get<std::vector<std::int64_t>>(value);
}

Json resolved_json(const Factor& factor) {
    Json json = {{"name", factor.name}};
    if (const auto* between = factor.between()) {
        json["between"] = {between->low, between->high};
        if (factor.log()) json["scale"] = "log";
    } else if (const auto* levels = factor.levels()) {
        json["levels"] = Json::array();
        for (const auto& value : levels->values) json["levels"].push_back(resolved_json(value));
    } else if (const auto column = stated_column(*factor.distribution())) {
        json["sample"] = {{"of", column->sample}, {"column", column->column}, {"values", column->values}};
    } else {
        json[std::string(name_of(*factor.distribution()))] = figures_of(*factor.distribution());
    }
    if (factor.step) json["step"] = *factor.step;
    if (!factor.group.empty()) json["group"] = factor.group;
    if (!factor.when.empty()) json["when"] = factor.when;
    return json;
}

/// Parameter whose values are those of a resolved factor.
ParameterSpec resolved_parameter(const Json& factor, const SceneInfo* scene) {
    ParameterSpec parameter{factor.at("name"), "1", "", Value{0.0}, Interval{}, {}};
    const Json levels = factor.value("levels", Json::array());
    if (!levels.empty() && levels.front().is_string()) {
        parameter.default_value = Value{std::string()};
        parameter.bounds = Words{levels.get<std::vector<std::string>>()};
    }
    if (!levels.empty() && levels.front().is_number_integer()) parameter.default_value = Value{std::int64_t{0}};
    const auto* known = scene == nullptr ? nullptr : scene->find_parameter(parameter.name);
    if (known != nullptr) parameter.unit = known->unit;
    return parameter;
}

std::vector<Factor> factors_of(const Cursor& place, const SceneInfo* scene) {
    std::vector<Factor> factors;
    Samples samples;
    for (const auto& element : place.elements()) {
        const auto parameter = resolved_parameter(element.json(), scene);
        factors.push_back(read_factor(Section(element, factor_keys), parameter, {}));
        factors.back().unit = scene == nullptr ? "" : parameter.unit;
        if (const auto sample = element.json().find("sample"); sample != element.json().end())
            samples.add(factors.size() - 1, {sample->at("column"), sample->at("of"), sample->at("values")});
    }
    std::move(samples).join(factors);
    return factors;
}

Value value_of(const Json& json) {
    if (json.is_string()) return json.get<std::string>();
    if (json.is_number_integer()) return json.get<std::int64_t>();
    return json.get<double>();
}

designs::OptionValue option_of(const Json& json) {
    if (json.is_array()) return json.get<std::vector<std::int64_t>>();
    return std::visit([](const auto& value) -> designs::OptionValue { return value; }, value_of(json));
}

}  // namespace

std::string text_of(const designs::OptionValue& value) {
    if (const auto* count = std::get_if<std::int64_t>(&value)) return std::to_string(*count);
    if (const auto* word = std::get_if<std::string>(&value)) return *word;
    if (const auto* number = std::get_if<double>(&value)) return shortest(*number);
    const auto* counts = std::get_if<std::vector<std::int64_t>>(&value);
    return counts == nullptr ? "" : fmt::format("{}", fmt::join(*counts, " "));
}

std::vector<std::string> text_lines(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

IdentityTexts texts_of(const Identity& identity) {
    IdentityTexts texts;
    for (const auto& factor : identity.factors) texts.factors += line_of(factor) + '\n';
    for (const auto& factor : identity.factors) texts.factors += ties_of(factor);
    for (const auto& [name, value] : identity.fixed)
        texts.fixed += fmt::format("{}{}{}\n", name, equals, identity_text(value));
    const auto* design = designs::find_design(identity.design);
    for (const auto& [name, value] : identity.options) {
        const bool extent = design != nullptr && std::ranges::any_of(design->options, [&](const auto& option) {
                                return option.extent && option.name == name;
                            });
        (extent ? texts.extent : texts.options) += fmt::format("{}{}{}\n", name, equals, text_of(value));
    }
    if (const auto& names = identity.common_random_numbers; !names.empty())
        texts.options += fmt::format("{}{}\n", common_mark, fmt::join(names, " "));
    return texts;
}

void read_texts(Identity& identity, const IdentityTexts& texts) {
    const auto scene = find_scene(identity.scene);
    Samples samples;
    for (const auto& line : text_lines(texts.factors)) {
        const bool grouped = line.starts_with(group_mark);
        if (!grouped && !line.starts_with(when_mark)) {
            add_factor(identity.factors, samples, line, scene.get());
            continue;
        }
        const auto [name, text] = split_once(line.substr((grouped ? group_mark : when_mark).size()), " ");
        const auto factor = std::ranges::find(identity.factors, name, &Factor::name);
        if (factor != identity.factors.end()) (grouped ? factor->group : factor->when) = text;
    }
    std::move(samples).join(identity.factors);
    for (const auto& line : text_lines(texts.fixed)) {
        const auto [name, text] = split_once(line, equals);
        const auto* parameter = scene == nullptr ? nullptr : scene->find_parameter(name);
        const bool word = parameter == nullptr || std::holds_alternative<std::string>(parameter->default_value);
        const auto value = number_or_text(text, word);
        identity.fixed[name] = word ? value : coerced(value, parameter->default_value);
    }
    const auto* design = designs::find_design(identity.design);
    for (const auto& line : text_lines(texts.options + texts.extent)) {
        const auto [name, text] = split_once(line, equals);
        if (line.starts_with(common_mark))
            identity.common_random_numbers = split(text, " ");
        else
            identity.options[name] = option_in(design, name, text);
    }
}

std::string factors_line(const std::vector<Factor>& factors) {
    std::vector<std::string> lines;
    for (const auto& factor : factors) lines.push_back(line_of(factor));
    return fmt::format("{}", fmt::join(lines, factor_separator));
}

std::vector<Factor> factors_in(std::string_view line) {
    std::vector<Factor> factors;
    Samples samples;
    for (const auto& part : split(line, factor_separator)) add_factor(factors, samples, part, nullptr);
    std::move(samples).join(factors);
    return factors;
}

std::string resolved_text(const Identity& identity) {
    Json json = {{"campaign", identity.name},
                 {"scene", identity.scene},
                 {"revision", identity.revision},
                 {"seed", identity.seed},
                 {"factors", Json::array()},
                 {"fixed", Json::object()},
                 {"design", {{"kind", identity.design}}}};
    for (const auto& factor : identity.factors) {
        json["factors"].push_back(resolved_json(factor));
        if (factor.share) json["simplex"].push_back(factor.name);
    }
    for (const auto& [name, value] : identity.fixed) json["fixed"][name] = resolved_json(value);
    if (!identity.condition.empty()) json["where"] = identity.condition;
    for (const auto& [name, value] : identity.options) json["design"][name] = resolved_json(value);
    if (const auto& names = identity.common_random_numbers; !names.empty()) json["common_random_numbers"] = names;
    return json.dump();
}

Identity read_resolved(std::string_view text) try {
    const Json json = Json::parse(text);
    Identity identity{.name = json.at("campaign"),
                      .scene = json.at("scene"),
                      .revision = json.at("revision"),
                      .seed = json.at("seed"),
                      .condition = json.value("where", ""),
                      .design = json.at("design").at("kind"),
                      .common_random_numbers = json.value("common_random_numbers", std::vector<std::string>())};
    const auto scene = find_scene(identity.scene);
    identity.factors = factors_of(Cursor(json.at("factors"), "$.factors"), scene.get());
    for (const auto& name : json.value("simplex", std::vector<std::string>())) {
        const auto factor = std::ranges::find(identity.factors, name, &Factor::name);
        if (factor == identity.factors.end()) throw input_error("$.simplex", name, "there is no such factor");
        factor->share = true;
    }
    for (const auto& [name, value] : json.at("fixed").items()) identity.fixed[name] = value_of(value);
    for (const auto& [name, value] : json.at("design").items())
        if (name != "kind") identity.options[name] = option_of(value);
    return identity;
} catch (const Json::exception&) {
    throw input_error("$", "", "a key of the campaign is missing, or its value is of another kind");
}

Inputs fixed_values(const Identity& identity, const SceneInfo& scene) {
    Inputs values;
    for (const auto& [name, value] : identity.fixed) {
        const auto* parameter = scene.find_parameter(name);
        const bool expression = std::holds_alternative<std::string>(value) && parameter != nullptr &&
                                !std::holds_alternative<std::string>(parameter->default_value);
        if (parameter != nullptr && !expression) values[name] = coerced(value, parameter->default_value);
    }
    return values;
}

std::optional<ParameterSpace> space_of(const Identity& identity) {
    const auto scene = find_scene(identity.scene);
    if (scene == nullptr || std::ranges::any_of(identity.factors, [&](const Factor& factor) {
            return scene->find_parameter(factor.name) == nullptr;
        }))
        return std::nullopt;
    return ParameterSpace{.scene = scene,
                          .factors = identity.factors,
                          .fixed = fixed_values(identity, *scene),
                          .expressions = expressions_of(identity, *scene)};
}

designs::DesignRequest request_of(const Identity& identity) {
    designs::DesignRequest request;
    request.seed = identity.seed;
    request.factors = identity.factors;
    request.groups = groups_of(identity.factors);
    for (const auto& factor : identity.factors) request.levels.push_back(factor.continuous() ? 0 : factor.parts());
    if (const auto* together = word_of(identity, "together")) request.shared = factors_in(*together);
    request.options = identity.options;
    designs::add_defaults(designs::design_named(identity.design), request.options);
    return request;
}

}  // namespace grainsweep::campaign
