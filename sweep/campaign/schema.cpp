#include "sweep/campaign/schema.hpp"

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/case.hpp"
#include "sweep/campaign/installed_machines.hpp"
#include "sweep/campaign/keys.hpp"
#include "sweep/campaign/machine.hpp"
#include "sweep/campaign/machine_keys.hpp"
#include "sweep/campaign/powder.hpp"
#include "sweep/campaign/powder_keys.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/campaign/program_keys.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>
#include <vector>

namespace grainsweep::campaign {

namespace {

using OrderedJson = nlohmann::ordered_json;

/// A number with or without a unit behind it; which units fit is the reader's to say.
constexpr std::string_view pattern_of_quantities = R"(^ *[+-]?[0-9.])";

OrderedJson notes_schema() {
    return {{"description", "any text; ignored"}, {"type", {"string", "array"}}, {"items", {{"type", "string"}}}};
}

OrderedJson number_of(double x) {
    const bool whole = x == std::floor(x) && std::abs(x) < 0x1p63;
    return whole ? OrderedJson(static_cast<std::int64_t>(x)) : OrderedJson(x);
}

void add_bounds(OrderedJson& schema, const Interval& bounds) {
    if (std::isfinite(bounds.low)) schema[bounds.low_open ? "exclusiveMinimum" : "minimum"] = number_of(bounds.low);
    if (std::isfinite(bounds.high)) schema[bounds.high_open ? "exclusiveMaximum" : "maximum"] = number_of(bounds.high);
}

/// A word that ends with a colon is the beginning of a text.
OrderedJson items_of(const std::vector<std::string>& words) {
    std::vector<std::string> whole, beginnings;
    for (const auto& word : words) (word.ends_with(':') ? beginnings : whole).push_back(word);
    OrderedJson items = {{"type", "string"}};
    if (beginnings.empty()) {
        items["enum"] = whole;
        return items;
    }
    items["anyOf"] = {{{"enum", whole}}, {{"pattern", fmt::format("^({})", fmt::join(beginnings, "|"))}}};
    return items;
}

OrderedJson section(std::span<const Field> fields);

/// A number, a text with a unit, or an expression.
OrderedJson quantity_schema() {
    return {{"type", {"number", "string"}}};
}

OrderedJson vector_schema() {
    return {{"type", "array"}, {"items", quantity_schema()}, {"minItems", 3}, {"maxItems", 3}};
}

/// A name or a list of names.
OrderedJson names_schema() {
    return {{"type", {"string", "array"}}, {"items", {{"type", "string"}}}};
}

/// Any number of entries by name.
OrderedJson named_schema(OrderedJson entry) {
    return {{"type", "object"},
            {"additionalProperties", std::move(entry)},
            {"properties", {{std::string(notes_key), notes_schema()}}}};
}

/// A word of a machine file, or the parameter that chooses it: "{NAME}".
OrderedJson word_or_parameter(OrderedJson word) {
    word["type"] = "string";
    return {{"anyOf", {std::move(word), {{"type", "string"}, {"pattern", R"(\{\w+\})"}}}}};
}

OrderedJson schema_of(const Field& key) {
    const std::vector<std::string> words(key.words.begin(), key.words.end());
    OrderedJson schema = {{"description", std::string(key.meaning)}};
    switch (key.kind) {
        case Field::Kind::text:
            schema["type"] = "string";
            schema["minLength"] = 1;
            break;
        case Field::Kind::word:
            schema["type"] = "string";
            if (!words.empty()) schema["enum"] = words;
            if (key.choose != nullptr) schema = word_or_parameter(std::move(schema));
            break;
        case Field::Kind::words:
            schema["type"] = "array";
            schema["items"] = {{"type", "string"}};
            if (!words.empty()) schema["items"] = items_of(words);
            break;
        case Field::Kind::whole:
            if (words.empty()) {
                schema["type"] = "integer";
                add_bounds(schema, key.bounds);
            } else {
                OrderedJson number = {{"type", "integer"}};
                add_bounds(number, key.bounds);
                schema["anyOf"] = {{{"enum", words}}, number};
            }
            break;
        case Field::Kind::number:
            schema["type"] = "number";
            add_bounds(schema, key.bounds);
            break;
        case Field::Kind::flag:
            schema["type"] = "boolean";
            break;
        case Field::Kind::quantity:
            schema.update(quantity_schema());
            add_bounds(schema, key.bounds);  // a rule for numbers only
            break;
        case Field::Kind::vector:
        case Field::Kind::direction:
            schema.update(vector_schema());
            break;
        case Field::Kind::region:
            schema["$ref"] = "#/$defs/region";
            break;
        case Field::Kind::species:
        case Field::Kind::particles:
        case Field::Kind::walls:
            schema.update(names_schema());
            break;
        case Field::Kind::object:
            schema["type"] = "object";
            if (!key.members.empty()) schema.update(section(key.members));
            break;
        case Field::Kind::named:
            schema.update(named_schema(section(key.members)));
            break;
        case Field::Kind::array:
            schema["type"] = "array";
            if (!key.members.empty()) schema["items"] = section(key.members);
            break;
        case Field::Kind::value:
            break;
    }
    if (auto value = OrderedJson::parse(key.standard, nullptr, false); !value.is_discarded())
        schema["default"] = std::move(value);  // "2/7" is an expression
    return schema;
}

/// Returns the schema of an object that has only the keys of a table and notes.
OrderedJson section(std::span<const Field> keys) {
    OrderedJson schema = {{"type", "object"}, {"properties", OrderedJson::object()}};
    OrderedJson required = OrderedJson::array();
    for (const auto& key : keys) {
        schema["properties"][std::string(key.name)] = schema_of(key);
        if (key.required) required.push_back(std::string(key.name));
    }
    schema["properties"][std::string(notes_key)] = notes_schema();
    if (!required.empty()) schema["required"] = required;
    schema["additionalProperties"] = false;
    return schema;
}

/// Returns the schema of one value of a parameter.
OrderedJson value_schema(const ParameterSpec& parameter) {
    OrderedJson schema;
    const bool dimensionless = parameter.unit.empty() || parameter.unit == "1";
    schema["description"] =
        dimensionless ? parameter.meaning : fmt::format("{} [{}]", parameter.meaning, parameter.unit);
    if (const auto* words = std::get_if<Words>(&parameter.bounds)) {
        schema["type"] = "string";
        if (!words->file_allowed) schema["enum"] = words->allowed;
        if (words->file_allowed) schema["examples"] = words->allowed;
    } else {
        // Bounds are a rule for numbers, the pattern one for texts: "60 um".
        schema["type"] = {std::holds_alternative<std::int64_t>(parameter.default_value) ? "integer" : "number",
                          "string"};
        schema["pattern"] = pattern_of_quantities;
        add_bounds(schema, std::get<Interval>(parameter.bounds));
    }
    std::visit([&schema](const auto& value) { schema["default"] = value; }, parameter.default_value);
    return schema;
}

/// Adds the figures of distributions. `value`: schema of one value of the parameter.
void add_distribution_keys(OrderedJson& properties, const OrderedJson& value) {
    const std::pair<const char*, std::span<const Field>> forms[] = {
        {"uniform", uniform_keys}, {"normal", normal_keys}, {"lognormal", lognormal_keys},
        {"weibull", weibull_keys}, {"gumbel", gumbel_keys}, {"triangular", triangular_keys},
        {"beta", beta_keys}};
    for (const auto& [name, keys] : forms) {
        auto& form = properties[name];
        form.update(section(keys));
        for (const auto& key : keys)
            if (key.kind == Field::Kind::value) form["properties"][std::string(key.name)]["type"] = value["type"];
    }
    properties["lognormal"]["oneOf"] = {{{"required", {"sigma"}}}, {{"required", {"ratio"}}}};
    OrderedJson named = section(sample_keys);
    named["oneOf"] = {{{"required", {"file"}}}, {{"required", {"powder"}}}};
    properties["sample"]["oneOf"] = {{{"type", "string"}, {"minLength", 1}}, std::move(named)};
}

/// A factor that is this parameter.
OrderedJson factor_schema(const ParameterSpec& parameter) {
    OrderedJson value = value_schema(parameter);
    const std::string meaning = value["description"];
    value.erase("description");
    value.erase("default");
    OrderedJson schema = section(factor_keys);
    schema["description"] = meaning;
    schema["properties"]["name"] = {{"const", parameter.name}, {"description", meaning}};
    schema["properties"]["levels"].update(
        {{"type", "array"}, {"minItems", 1}, {"uniqueItems", true}, {"items", value}});
    auto& properties = schema["properties"];
    const bool whole = std::holds_alternative<std::int64_t>(parameter.default_value);
    if (!std::holds_alternative<double>(parameter.default_value))
        for (const auto key : range_keys)
            if (key != "levels" && !(whole && key == "between")) properties.erase(std::string(key));
    if (std::holds_alternative<std::string>(parameter.default_value)) {
        for (const char* key : {"scale", "step", "whole"}) properties.erase(key);
        schema["required"] = {"name", "levels"};
        return schema;
    }
    properties["between"].update({{"type", "array"}, {"minItems", 2}, {"maxItems", 2}, {"items", value}});
    properties["step"].update({{"type", value["type"]}, {"pattern", pattern_of_quantities}, {"exclusiveMinimum", 0}});
    if (whole) {
        OrderedJson between = {{"required", {"between"}}};
        between["anyOf"] = {{{"required", {"whole"}}}, {{"required", {"step"}}}};
        schema["oneOf"] = {between, {{"required", {"levels"}}}};
        return schema;
    }
    add_distribution_keys(properties, value);
    schema["oneOf"] = OrderedJson::array();
    for (const auto key : range_keys) schema["oneOf"].push_back({{"required", {std::string(key)}}});
    return schema;
}

/// A setting by its name, or a goal.
OrderedJson accuracy_schema(const OrderedJson& offered, const OrderedJson& scalars) {
    OrderedJson goal = section(accuracy_keys);
    if (!scalars.empty()) goal["properties"]["observable"]["enum"] = scalars;
    goal["properties"]["setting"]["enum"] = offered;
    OrderedJson schema;
    schema["oneOf"] = {{{"enum", offered}}, goal};
    return schema;
}

/// Returns the rule for campaigns of this scene: names of parameters, scalars and accuracy settings.
OrderedJson scene_rule(const SceneInfo& scene) {
    OrderedJson factors = OrderedJson::array();
    OrderedJson fixed = OrderedJson::object();
    for (const auto& parameter : scene.parameters) {
        factors.push_back(factor_schema(parameter));
        fixed[parameter.name] = value_schema(parameter);
        fixed[parameter.name].erase("pattern");  // an expression is any text
    }
    fixed[std::string(notes_key)] = notes_schema();
    OrderedJson scalars = OrderedJson::array();
    for (const auto& observable : scene.observables) {
        if (observable.shape == Shape::scalar) scalars.push_back(observable.name);
    }
    OrderedJson then = OrderedJson::object();
    then["factors"]["items"]["oneOf"] = factors;
    then["fixed"] = {{"properties", fixed}, {"additionalProperties", false}};
    then["convergence"]["properties"]["observable"]["enum"] = scalars;
    OrderedJson offered = OrderedJson::array();
    for (const auto& [name, inputs] : scene.accuracy) offered.push_back(name);
    then["accuracy"] = offered.empty() ? OrderedJson(false) : accuracy_schema(offered, scalars);
    OrderedJson condition;
    condition["properties"]["scene"]["const"] = scene.shown();
    condition["required"] = {"scene"};
    return {{"if", condition}, {"then", {{"properties", then}}}};
}

OrderedJson design_schema(const designs::DesignInfo& design) {
    const auto keys = design_keys(design);
    OrderedJson schema = section(keys);
    schema["description"] = design.summary;
    schema["properties"]["kind"] = {{"const", design.name}, {"description", design.summary}};
    for (const auto& option : design.options) {
        auto& property = schema["properties"][std::string(option.name)];
        if (option.kind == Field::Kind::value) {
            OrderedJson count = {{"type", "integer"}};
            add_bounds(count, option.bounds);
            property["oneOf"] = {count, {{"type", "array"}, {"items", count}}};
        } else if (option.kind == Field::Kind::array) {
            property["minItems"] = 1;
            property["items"] = {{"type", "array"}, {"items", {{"type", {"number", "string"}}}}};
            schema["oneOf"] = {{{"required", {option.name}}}, {{"required", {"file"}}}};
        }
    }
    return schema;
}

/// Returns the properties of a powder file; scenes have parameters of the same names.
OrderedJson properties_of_powder(std::span<const Field> keys) {
    OrderedJson schema = section(keys);
    for (const auto& key : keys) {
        auto& property = schema["properties"][std::string(key.name)];
        property.update(value_schema(powder_parameter(key.name)));
        property.erase("default");  // properties that a powder file lacks keep the scene's default
    }
    return schema;
}

/// Numbers above 0, or texts with a unit.
OrderedJson positive_values(std::span<const Field> keys) {
    OrderedJson schema = section(keys);
    for (const auto& key : keys)
        if (key.kind == Field::Kind::value)
            schema["properties"][std::string(key.name)].update(
                {{"type", {"number", "string"}}, {"pattern", pattern_of_quantities}, {"exclusiveMinimum", 0}});
    return schema;
}

OrderedJson sizes_of_powder() {
    OrderedJson schema = positive_values(powder_keys::sizes);
    auto& properties = schema["properties"];
    properties["lognormal"].update(positive_values(powder_keys::lognormal));
    properties["lognormal"]["oneOf"] = {{{"required", {"sigma"}}}, {{"required", {"ratio"}}}};
    properties["rosin_rammler"].update(positive_values(powder_keys::rosin_rammler));
    schema["oneOf"] = OrderedJson::array();
    for (const char* key : {"file", "diameter", "d50", "lognormal", "rosin_rammler"})
        schema["oneOf"].push_back({{"required", {key}}});
    for (const char* key : {"d10", "d50", "d90"}) schema["dependentRequired"][key] = {"d10", "d50", "d90"};
    return schema;
}

/// Of a scene that the key of the same name defines: names of parameters are not known here.
OrderedJson defined_scene_rule(std::string_view word, OrderedJson accuracy) {
    OrderedJson then = OrderedJson::object();
    const OrderedJson name = {{"type", "string"}, {"pattern", "^[A-Za-z_][A-Za-z0-9_]*$"}};
    then["factors"]["items"] = section(factor_keys);
    then["factors"]["items"]["properties"]["name"].update(name);
    then["fixed"] = {{"additionalProperties", {{"type", {"number", "string"}}}},
                     {"properties", {{std::string(notes_key), notes_schema()}}}};
    then["accuracy"] = std::move(accuracy);
    const std::string key(word);
    OrderedJson condition, absent;
    condition["properties"]["scene"]["const"] = key;
    condition["required"] = {"scene"};
    absent[key] = false;
    return {{"if", condition},
            {"then", {{"properties", then}, {"required", OrderedJson::array({key})}}},
            {"else", {{"properties", absent}}}};
}

OrderedJson program_section_schema() {
    OrderedJson schema = section(program_keys);
    auto& properties = schema["properties"];
    properties["command"]["minItems"] = 1;
    properties["environment"]["additionalProperties"] = {{"type", "string"}};
    properties["parameters"].update(named_schema(section(program_parameter_keys)));
    OrderedJson observable = section(program_observable_keys);
    observable["properties"]["from"].update(section(program_from_keys));
    observable["properties"]["from"]["oneOf"] = {
        {{"required", {"json", "path"}}}, {{"required", {"csv", "column"}}}, {{"required", {"output"}}}};
    properties["observables"].update(named_schema(std::move(observable)));
    properties["version"].update(section(program_version_keys));
    return schema;
}

/// Returns a pattern of the names that the reader refuses, in upper and lower case as in SQL.
std::string pattern_of_reserved_names() {
    const auto folded = [](std::string_view word) {
        std::string pattern;
        for (const char c : word)
            pattern += c == '_' ? std::string("_") : fmt::format("[{}{}]", static_cast<char>(c - 'a' + 'A'), c);
        return pattern;
    };
    std::string pattern = fmt::format("^(?:{}.*", folded("sqlite_"));
    for (const auto& name : reserved_names) pattern += "|" + folded(name);
    return pattern + ")$";
}

/// Returns the schema of a file with these fields.
OrderedJson file_schema(std::string_view file, std::string_view description, OrderedJson object) {
    OrderedJson schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                          {"title", fmt::format("grainsweep {}", file)},
                          {"description", fmt::format("{}; SI units where a number has no unit", description)}};
    schema.update(object);
    schema["properties"][std::string(schema_key)] = {{"description", "where an editor finds the schema; ignored"},
                                                     {"type", "string"}};
    return schema;
}

}  // namespace

std::string powder_schema(int indentation) {
    OrderedJson schema = file_schema("powder", "material, sizes, contacts", section(powder_keys::top));
    auto& properties = schema["properties"];
    properties["material"].update(properties_of_powder(powder_keys::material));
    properties["contacts"].update(properties_of_powder(powder_keys::contacts()));
    properties["sizes"].update(sizes_of_powder());
    properties["cut"].update(positive_values(powder_keys::cut));
    properties["cut"]["minProperties"] = 1;
    properties["measured"]["items"] = section(powder_keys::measured);
    for (const char* key : {"value", "error"})
        properties["measured"]["items"]["properties"][key]["type"] = {"number", "string"};
    return schema.dump(indentation);
}

std::string machine_schema(int indentation) {
    namespace keys = machine_keys;
    OrderedJson schema =
        file_schema("machine", "bodies, powder, motions, phases and what is measured", section(keys::top()));
    const auto one_of = [](std::span<const Type> types, std::initializer_list<const char*> others) {
        OrderedJson rules = OrderedJson::array();
        for (const Type& type : types) rules.push_back({{"required", {type.name}}});
        for (const char* other : others) rules.push_back({{"required", {other}}});
        return rules;
    };
    auto& properties = schema["properties"];
    properties["let"] = named_schema({{"type", {"number", "string", "object"}}});
    properties["gravity"]["anyOf"] = {vector_schema(), section(keys::gravity)};
    auto& wall = properties["walls"]["additionalProperties"];
    wall["oneOf"] = one_of(keys::shapes(), {"triangles", "stl"});
    wall["properties"]["during"] = names_schema();
    wall["properties"]["motion"]["items"]["oneOf"] = one_of(keys::motions(), {});
    wall["properties"]["motion"]["items"]["properties"]["during"] = names_schema();
    auto& fill = properties["fill"]["items"]["properties"];
    fill["spheres"]["anyOf"] = {{{"type", "string"}}, {{"type", "array"}, {"items", section(keys::sphere)}}};
    fill["mix"] = named_schema(quantity_schema());
    fill["by"] = word_or_parameter(fill["by"]);
    auto& spread = properties["species"]["additionalProperties"]["properties"]["sizes"]["properties"]["spread"];
    spread = word_or_parameter(spread);
    auto& feed = properties["feed"]["items"]["properties"];
    feed["during"] = names_schema();
    feed["mix"] = named_schema(quantity_schema());
    feed["by"] = word_or_parameter(feed["by"]);
    OrderedJson disc = {{"type", "object"}, {"required", {"disc"}}};
    disc["properties"]["disc"] =
        section(std::ranges::find(keys::shapes(), std::string_view("disc"), &Type::name)->fields);
    feed["through"]["anyOf"] = {{{"$ref", "#/$defs/region"}}, std::move(disc)};
    OrderedJson until = section(keys::until);
    properties["phases"]["items"]["properties"]["until"]["anyOf"] = {until, {{"type", "array"}, {"items", until}}};

    OrderedJson probe = section(keys::measure);
    probe["properties"]["during"] = names_schema();
    OrderedJson probes = OrderedJson::array();
    for (const auto& info : keys::probes()) {
        auto& options = probe["properties"][std::string(info.name)] = section(info.fields);
        options["description"] = info.meaning;
        probes.push_back({{"required", {info.name}}});
    }
    probe["oneOf"] = std::move(probes);
    OrderedJson entry;
    entry["anyOf"] = {{{"type", "string"}}, section(keys::expression), section(keys::time_of), std::move(probe)};
    properties["measure"].update(named_schema(std::move(entry)));

    OrderedJson region = {{"type", "object"}, {"minProperties", 1}, {"maxProperties", 1}};
    const OrderedJson inner = {{"$ref", "#/$defs/region"}};
    for (const Type& type : keys::regions()) {
        auto& form = region["properties"][std::string(type.name)];
        form = !type.fields.empty() ? section(type.fields)
               : type.name == "not" ? inner
                                    : OrderedJson{{"type", "array"}, {"items", inner}, {"minItems", 1}};
        form["description"] = type.meaning;
    }
    region["additionalProperties"] = false;
    schema["$defs"]["region"] = std::move(region);
    return schema.dump(indentation);
}

std::string program_schema(int indentation) {
    return file_schema("program", "the section \"program\" of a campaign file", program_section_schema())
        .dump(indentation);
}

std::string campaign_schema(int indentation) {
    OrderedJson schema = file_schema("campaign", "one scene, factors that vary, a design over them, and when to stop",
                                     section(campaign_keys));
    // Members are kept in a vector: all of this level stand before one of them is referred to.
    schema["oneOf"] = {{{"required", {"design"}}}, {{"required", {"calibration"}}}};
    schema["allOf"] = OrderedJson::array();
    auto& properties = schema["properties"];
    properties["campaign"]["pattern"] = "^[A-Za-z_][A-Za-z0-9_]*$";
    properties["campaign"]["maxLength"] = longest_campaign_name;
    properties["campaign"]["not"]["pattern"] = pattern_of_reserved_names();
    properties["factors"]["minItems"] = 1;
    properties["simplex"].update({{"minItems", 2}, {"uniqueItems", true}});
    properties["convergence"].update(section(convergence_keys));
    properties["accuracy"]["oneOf"] = {{{"type", "string"}}, section(accuracy_keys)};
    properties["model"].update(section(model_keys));
    properties["model"]["properties"]["features"].update({{"minItems", 1}, {"maxItems", most_features}});
    properties["calibration"].update(section(calibration_keys));
    auto& calibration = properties["calibration"]["properties"];
    calibration["targets"]["items"] = section(target_keys);
    for (const char* key : {"value", "error"})
        calibration["targets"]["items"]["properties"][key]["type"] = {"number", "string"};
    calibration["targets"]["items"]["properties"]["without_value"].update(section(without_value_keys));
    calibration["experiments"]["minProperties"] = 1;
    calibration["experiments"]["additionalProperties"] = section(experiment_keys);
    calibration["experiments"]["properties"][std::string(notes_key)] = notes_schema();
    OrderedJson several;
    several["required"] = {"calibration"};
    several["properties"]["calibration"]["required"] = {"experiments"};
    schema["anyOf"] = {{{"required", {"scene"}}}, several};
    properties["calibration"]["properties"]["stop"].update(section(stop_keys));
    properties["program"].update(program_section_schema());
    properties["limits"].update(section(limits_keys));
    properties["execution"].update(section(execution_keys));
    properties["design"]["oneOf"] = OrderedJson::array();
    for (const auto& design : designs::design_catalogue())
        properties["design"]["oneOf"].push_back(design_schema(design));
    OrderedJson scenes = OrderedJson::array();
    for (const auto& scene : named_scenes()) {
        scenes.push_back(scene->shown());
        schema["allOf"].push_back(scene_rule(*scene));
    }
    scenes.push_back(program_word);
    schema["allOf"].push_back(
        defined_scene_rule(program_word, {{"oneOf", {{{"type", "string"}}, section(accuracy_keys)}}}));
    scenes.push_back(machine_word);
    schema["allOf"].push_back(defined_scene_rule(
        machine_word, accuracy_schema(OrderedJson::array({"fast", "balanced", "fine", "reference"}), {})));
    properties["machine"]["type"] = {"string", "object"};
    properties["scene"]["enum"] = scenes;
    return schema.dump(indentation);
}

}  // namespace grainsweep::campaign
