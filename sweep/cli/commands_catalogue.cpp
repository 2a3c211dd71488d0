// scenes, designs, schema: catalogues, from the tables that the reader of campaign files uses for its checks.
#include "sweep/campaign/case.hpp"
#include "sweep/campaign/cursor.hpp"
#include "sweep/campaign/field_text.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/installed_machines.hpp"
#include "sweep/campaign/machine.hpp"
#include "sweep/campaign/machine_keys.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/campaign/program_keys.hpp"
#include "sweep/campaign/schema.hpp"
#include "sweep/cli/command.hpp"
#include "sweep/designs/design.hpp"

#include "solver/scenes/scene.hpp"
#include "sweep/report/result.hpp"
#include "sweep/report/results/catalogues.hpp"

#include <fmt/format.h>

#include <cmath>
#include <iostream>

namespace grainsweep::cli {

namespace {

using report::Format;
using report::Json;
using report::Result;
namespace results = report::results;
using Cell = store::Table::Cell;

Cell text_or_none(const std::string& text) {
    return text.empty() ? Cell{} : Cell{text};
}

std::string alternatives(const auto& words) {
    return fmt::format("{}", fmt::join(words, " | "));
}

std::string condition_text(const Relevance& condition) {
    switch (condition.condition) {
        case Relevance::Condition::zero:
            return condition.other + " = 0";
        case Relevance::Condition::nonzero:
            return condition.other + " != 0";
        case Relevance::Condition::is_word:
            return condition.other + " is " + alternatives(condition.words);
        case Relevance::Condition::is_file:
            return condition.other + " is a file";
    }
    return {};
}

std::string conditions_text(const ParameterSpec& parameter) {
    std::string text;
    for (const auto& condition : parameter.relevant_if)
        text += (text.empty() ? "" : " and ") + condition_text(condition);
    return text;
}

std::string_view word_of(Shape shape) {
    return shape == Shape::scalar ? "scalar" : shape == Shape::series ? "series" : "profile";
}

/// Returns the cells of the columns low, high and words, empty if they do not apply. An open end is marked in the text
/// of the bound's cell.
std::vector<Cell> bound_cells(const ParameterSpec& parameter) {
    if (const auto* words = std::get_if<Words>(&parameter.bounds)) {
        return {Cell{}, Cell{}, alternatives(words->allowed) + (words->file_allowed ? " | a file" : "")};
    }
    const auto& bounds = std::get<Interval>(parameter.bounds);
    const auto end = [](double x, bool open, const char* sign) -> Cell {
        if (!std::isfinite(x)) return {};
        return open ? Cell{sign + campaign::shortest(x)} : Cell{x};
    };
    return {end(bounds.low, bounds.low_open, "> "), end(bounds.high, bounds.high_open, "< "), Cell{}};
}

store::Table parameters_of(const SceneInfo& scene) {
    store::Table table{{"parameter", "unit", "default", "low", "high", "words", "matters if", "meaning"}, {}};
    for (const auto& parameter : scene.parameters) {
        const auto bounds = bound_cells(parameter);
        table.rows.push_back({parameter.name, text_or_none(parameter.unit), report::to_cell(parameter.default_value),
                              bounds[0], bounds[1], bounds[2], text_or_none(conditions_text(parameter)),
                              parameter.meaning});
    }
    return table;
}

/// Returns the allowed values as one text: "0 to 2", "above 0", "sjkr | paper".
std::string allowed_text(const ParameterSpec& parameter) {
    if (std::holds_alternative<Words>(parameter.bounds)) return std::get<std::string>(bound_cells(parameter)[2]);
    const auto& bounds = std::get<Interval>(parameter.bounds);
    const bool below = std::isfinite(bounds.low), above = std::isfinite(bounds.high);
    const std::string low = (bounds.low_open ? "above " : "") + campaign::shortest(bounds.low);
    const std::string high = (bounds.high_open ? "below " : "") + campaign::shortest(bounds.high);
    if (below && above) return low + " to " + high;
    if (below) return bounds.low_open ? low : "from " + low;
    return above ? (bounds.high_open ? high : "up to " + high) : "any number";
}

/// The parameters for reading: fewer columns than parameters_of, which is for programs.
store::Table parameter_lines(const SceneInfo& scene) {
    store::Table table{{"parameter", "unit", "default", "allowed", "meaning"}, {}};
    for (const auto& parameter : scene.parameters) {
        const auto conditions = conditions_text(parameter);
        table.rows.push_back({parameter.name, text_or_none(parameter.unit), campaign::to_text(parameter.default_value),
                              allowed_text(parameter),
                              parameter.meaning + (conditions.empty() ? "" : " (only if " + conditions + ")")});
    }
    return table;
}

store::Table observables_of(const SceneInfo& scene) {
    store::Table table{{"observable", "unit", "shape", "over", "meaning"}, {}};
    for (const auto& observable : scene.observables) {
        table.rows.push_back({observable.name, text_or_none(observable.unit), std::string(word_of(observable.shape)),
                              text_or_none(observable.over), observable.meaning});
    }
    return table;
}

Json json_of(const ParameterSpec& parameter) {
    const auto type = parameter.default_value.index();
    Result<results::parameter> object = {{"name", parameter.name},
                                         {"unit", parameter.unit},
                                         {"meaning", parameter.meaning},
                                         {"type", type == 0   ? "number"
                                                  : type == 1 ? "integer"
                                                              : "word"},
                                         {"default", report::to_json(report::to_cell(parameter.default_value))}};
    if (const auto* words = std::get_if<Words>(&parameter.bounds)) {
        object.add("words", words->allowed).add("file_allowed", words->file_allowed);
    } else {
        const auto& bounds = std::get<Interval>(parameter.bounds);
        object.add("low", bounds.low)
            .add("high", bounds.high)
            .add("low_open", bounds.low_open)
            .add("high_open", bounds.high_open);
    }
    return object.add("matters_if", Json::list(parameter.relevant_if, condition_text));
}

Json json_of(const SceneInfo& scene) {
    const auto json_of_observable = [](const ObservableSpec& observable) {
        return Result<results::observable>{{"name", observable.name},
                                           {"unit", observable.unit},
                                           {"meaning", observable.meaning},
                                           {"shape", word_of(observable.shape)},
                                           {"over", observable.over}};
    };
    Json accuracy = Json::object();
    for (const auto& [name, inputs] : scene.accuracy) accuracy.add(name, report::to_json(inputs));
    return Result<results::scene>{
        {"name", scene.shown()},
        {"summary", scene.summary},
        {"revision", scene.revision},
        {"parameters", Json::list(scene.parameters, [](const auto& parameter) { return json_of(parameter); })},
        {"observables", Json::list(scene.observables, json_of_observable)},
        {"accuracy", accuracy}};
}

void show_scene(const SceneInfo& scene, Format format) {
    if (format == Format::json) return report::write(std::cout, json_of(scene));
    if (format == Format::csv) return report::write(std::cout, parameters_of(scene), format);
    std::cout << fmt::format("{}, revision {}: {}\n\n", scene.shown(), scene.revision, scene.summary);
    report::write(std::cout, parameter_lines(scene), format);
    std::cout << '\n';
    report::write(std::cout, observables_of(scene), format);
    for (const auto& [name, inputs] : scene.accuracy) {
        std::cout << fmt::format("\naccuracy {}:", name);
        for (const auto& [input, value] : inputs) std::cout << fmt::format(" {} = {}", input, campaign::to_text(value));
    }
    if (!scene.accuracy.empty()) std::cout << '\n';
}

/// Appends the fields of a type. `object`: its name in the table.
void add_fields(store::Table& table, std::string_view object, const Type& type) {
    for (const auto& field : type.fields) {
        const auto one_of = field.words.empty() ? "" : "; one of " + alternatives(field.words);
        table.rows.push_back(
            {std::string(object), std::string(field.name),
             field.required ? Cell{std::string("required")} : text_or_none(campaign::default_text(type, field)),
             campaign::meaning_text(field) + one_of});
    }
}

/// The keys of a machine file, object by object, shapes and regions among them.
store::Table machine_table() {
    store::Table table{report::columns_of(results::section_key), {}};
    for (const Type& type : campaign::machine_keys::all()) add_fields(table, type.name, type);
    for (const Type& type : campaign::machine_keys::shapes())
        add_fields(table, fmt::format("shape {}", type.name), type);
    for (const Type& type : campaign::machine_keys::regions())
        add_fields(table, fmt::format("region {}", type.name), type);
    return table;
}

/// The keys of the section "program", object by object.
store::Table program_table() {
    store::Table table{report::columns_of(results::section_key), {}};
    const auto add = [&](const char* object, std::span<const Field> keys) {
        add_fields(table, object, {object, {}, keys});
    };
    add("program", campaign::program_keys);
    add("parameters.NAME", campaign::program_parameter_keys);
    add("observables.NAME", campaign::program_observable_keys);
    add("observables.NAME.from", campaign::program_from_keys);
    add("version", campaign::program_version_keys);
    return table;
}

/// A scene whose parameters and observables a file gives: the keys of that file, and `last`.
void show_keys(std::string_view word, std::string_view summary, const store::Table& table, std::string_view last,
               Format format) {
    if (format == Format::csv) return report::write(std::cout, table, format);
    if (format == Format::json) {
        return report::write(std::cout, Result<results::scene>{{"name", word},
                                                               {"summary", summary},
                                                               {"revision", 1},
                                                               {"parameters", Json::array()},  // the file's own
                                                               {"observables", Json::array()},
                                                               {"accuracy", Json::object()},
                                                               {"section", report::to_json(table)}});
    }
    std::cout << fmt::format("{}: {}\n\n", word, summary);
    report::write(std::cout, table, format);
    std::cout << '\n' << last << '\n';
}

int list_scenes(const std::string& name, Format format) {
    const std::vector<std::string> known = campaign::scene_words();
    if (name == campaign::program_word) {
        show_keys(name, campaign::program_summary(), program_table(),
                  "The parameters are the factors and fixed values of the campaign file; the observables are those of "
                  "its \"program\".",
                  format);
        return 0;
    }
    if (name == campaign::machine_word) {
        show_keys(name, campaign::machine_summary(), machine_table(),
                  "Parameters and observables are those of the machine file; docs/machines_reference.md lists probes.",
                  format);
        return 0;
    }
    if (!name.empty()) {
        const auto scene = campaign::scene_named(name);
        if (scene == nullptr) {
            throw campaign::input_error("NAME", name, "there is no such scene; grainsweep scenes lists them",
                                        campaign::nearest_word(name, known));
        }
        show_scene(*scene, format);
        return 0;
    }
    store::Table table{report::columns_of(results::listed_scene), {}};
    for (const auto& scene : campaign::named_scenes())
        table.rows.push_back({scene->shown(), std::int64_t{scene->revision},
                              static_cast<std::int64_t>(scene->parameters.size()),
                              static_cast<std::int64_t>(scene->observables.size()), scene->summary});
    table.rows.push_back({std::string(campaign::machine_word), std::int64_t{1}, Cell{}, Cell{},
                          std::string(campaign::machine_summary())});
    table.rows.push_back({std::string(campaign::program_word), std::int64_t{1}, Cell{}, Cell{},
                          std::string(campaign::program_summary())});
    report::write(std::cout, table, format);
    return 0;
}

int list_machines(const std::string& name, Format format) {
    if (!name.empty()) {
        show_scene(*campaign::enter_machine(campaign::machine_named("NAME", name)), format);
        return 0;
    }
    store::Table table{report::columns_of(results::listed_machine), {}};
    for (const auto& installed : campaign::installed_machines()) {
        const auto machine = campaign::installed_machine(installed);
        table.rows.push_back({installed, std::string(campaign::kind_of_installed(installed)),
                              static_cast<std::int64_t>(machine->parameters.size()),
                              static_cast<std::int64_t>(machine->observables.size()), machine->summary});
    }
    report::write(std::cout, table, format);
    return 0;
}

std::string default_text(const designs::OptionSpec& option) {
    if (!option.default_value()) return "required";
    std::string text(option.standard);
    std::erase(text, '"');
    return text;
}

std::string allowed_text(const designs::OptionSpec& option) {
    using Kind = Field::Kind;
    using Names = designs::OptionSpec::Names;
    if (option.kind == Kind::word) return alternatives(option.words);
    if (option.names == Names::factors) return "a factor that varies between two values";
    if (option.names == Names::observables) return "a scalar observable of the scene";
    if (option.kind == Kind::number) return "a number" + campaign::in_words(option.bounds);
    if (option.kind == Kind::array) return "[[...], ...] or \"file\": a CSV file";
    const std::string one = fmt::format("{:.0f} to {:.0f}", option.bounds.low, option.bounds.high);
    return option.kind == Kind::value ? one + ", one number or one per factor" : one;
}

store::Table options_of(const designs::DesignInfo& design) {
    store::Table table{report::columns_of(results::option), {}};
    for (const auto& option : design.options) {
        table.rows.push_back(
            {std::string(option.name), default_text(option), allowed_text(option), std::string(option.meaning)});
    }
    return table;
}

int list_designs(const std::string& name, Format format) {
    std::vector<std::string> known;
    for (const auto& design : designs::design_catalogue()) known.push_back(design.name);
    if (name.empty()) {
        store::Table table{report::columns_of(results::listed_design), {}};
        for (const auto& design : designs::design_catalogue()) {
            table.rows.push_back({design.name, std::string(design.extends ? "yes" : "no"), design.summary});
        }
        report::write(std::cout, table, format);
        return 0;
    }
    const auto* design = designs::find_design(name);
    if (design == nullptr) {
        throw campaign::input_error("NAME", name, "there is no such design; grainsweep designs lists them",
                                    campaign::nearest_word(name, known));
    }
    if (format == Format::json) {
        report::write(std::cout, Result<results::design>{{"name", design->name},
                                                         {"summary", design->summary},
                                                         {"extends", design->extends},
                                                         {"options", report::to_json(options_of(*design))}});
        return 0;
    }
    if (format == Format::text) std::cout << fmt::format("{}: {}\n\n", design->name, design->summary);
    report::write(std::cout, options_of(*design), format);
    return 0;
}

int print_schema(const std::string& name, Format format) {
    static const std::map<std::string, std::string (*)(int), std::less<>> schemas = {
        {"campaign", campaign::campaign_schema},
        {"machine", campaign::machine_schema},
        {"powder", campaign::powder_schema},
        {"program", campaign::program_schema}};
    const auto found = schemas.find(name.empty() ? "campaign" : name);
    if (found == schemas.end())
        throw campaign::input_error("NAME", name, "there are the schemas campaign, machine, powder and program",
                                    campaign::nearest_word(name, campaign::WordList(std::views::keys(schemas))));
    const auto schema = found->second;
    if (format == Format::csv)
        report::write(std::cout, store::Table{{"schema"}, {{schema(2)}}}, format);
    else
        std::cout << schema(format == Format::json ? campaign::on_one_line : 2) << '\n';
    return 0;
}

void declare_name(Parser& parser, std::string& name) {
    parser.add_option("[NAME]", name, "one of them, in detail");
}

}  // namespace

std::vector<Command> catalogue_commands() {
    return {
        command<std::string>("scenes", "lists the scenes, or the parameters and observables of one scene", declare_name,
                             list_scenes),
        command<std::string>("machines",
                             "lists the machines that are installed, or the parameters and observables of one machine",
                             declare_name, list_machines),
        command<std::string>("designs", "lists the designs, or the options of one design", declare_name, list_designs),
        verbatim(command<std::string>(
            "schema", "prints the JSON Schema of a campaign, machine or powder file, or of a section \"program\"",
            [](Parser& parser, std::string& name) {
                parser.add_option("[NAME]", name, "campaign, the default, machine, powder or program");
            },
            print_schema)),
    };
}

}  // namespace grainsweep::cli
