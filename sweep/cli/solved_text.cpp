#include "sweep/cli/solved_text.hpp"

#include "solver/scenes/scene.hpp"
#include "sweep/report/main_observables.hpp"
#include "sweep/report/print_axes.hpp"
#include "sweep/report/table.hpp"

#include <fmt/format.h>

#include <ostream>
#include <variant>

namespace grainsweep::cli {

namespace {

using campaign::CaseResult;
using campaign::Outcome;
using report::Format;
using Cell = store::Table::Cell;

constexpr std::size_t most_inputs = 6;

/// Returns the value as the user would write it: "5.55 mm", "jkr", the number of a count.
std::string input_text(const ParameterSpec& parameter, const Value& value) {
    const auto* real = std::get_if<double>(&value);
    return real != nullptr ? report::quantity_text(*real, parameter.unit) : campaign::to_text(value);
}

}  // namespace

std::vector<ObservableSpec> absent(const campaign::Case& question, const CaseResult& result) {
    std::vector<ObservableSpec> missing;
    if (result.outcome != Outcome::completed) return missing;
    for (const auto& observable : find_scene(question.scene)->observables)
        if (observable.shape == Shape::scalar && !result.observations.scalars.contains(observable.name))
            missing.push_back(observable);
    return missing;
}

void write_main_case(std::ostream& out, const campaign::Case& question, std::span<const std::string> inputs,
                     const CaseResult& result) {
    const auto& scene = *find_scene(question.scene);
    out << fmt::format("{}: {}{}{}; {:.3g} s\n\n", scene.shown(), campaign::to_string(result.outcome),
                       result.message.empty() ? "" : ": ", result.message, result.cost.wall_seconds);
    store::Table set{{"input", "value"}, {}};
    for (const auto& name : inputs.first(std::min(inputs.size(), most_inputs)))
        if (const auto* parameter = scene.find_parameter(name))
            set.rows.push_back({name, input_text(*parameter, question.inputs.at(name))});
    if (!set.rows.empty()) report::write(out, set, Format::text);
    if (inputs.size() > most_inputs) out << fmt::format("and {} more\n", inputs.size() - most_inputs);
    if (result.observations.scalars.empty()) return;
    if (!set.rows.empty()) out << '\n';
    store::Table answers{{"observable", "value", "meaning"}, {}};
    for (const auto& [name, words] : report::main_observables(scene)) {
        const auto found = result.observations.scalars.find(name);
        const bool known = found != result.observations.scalars.end();
        answers.rows.push_back(
            {name, known ? report::quantity_text(found->second, scene.find_observable(name)->unit) : "-", words});
    }
    report::write(out, answers, Format::text);
    if (const auto missing = absent(question, result).size(); missing > 0)
        out << fmt::format("{} of all observables are undefined in this case; --all gives the reasons\n", missing);
    out << '\n';
}

void write_whole_case(std::ostream& out, const campaign::Case& question, const CaseResult& result) {
    const auto& scene = *find_scene(question.scene);
    store::Table table{{"name", "value", "unit", "meaning"}, {}};
    for (const auto& parameter : scene.parameters) {
        const Value& value = question.inputs.at(parameter.name);
        if (value == parameter.default_value) continue;
        table.rows.push_back({parameter.name, campaign::to_text(value), parameter.unit, parameter.meaning});
    }
    table.rows.push_back({std::string("seed"), std::to_string(question.seed), std::string(), std::string()});
    report::write(out, table, Format::text);
    out << fmt::format("\n{}{}{}\n\n", campaign::to_string(result.outcome), result.message.empty() ? "" : ": ",
                       result.message);
    store::Table answers{{"observable", "value", "unit", "meaning"}, {}};
    for (const auto& observable : scene.observables) {
        Cell value;
        if (const auto found = result.observations.scalars.find(observable.name);
            found != result.observations.scalars.end()) {
            value = report::to_cell(found->second);
        } else if (const auto series = result.observations.series.find(observable.name);
                   series != result.observations.series.end()) {
            value = fmt::format("{} values", series->second.size());
        } else {
            continue;
        }
        answers.rows.push_back({observable.name, value, observable.unit, observable.meaning});
    }
    if (!answers.rows.empty()) report::write(out, answers, Format::text);
    const auto missing = absent(question, result);
    if (!missing.empty()) out << "\nwithout a value\n";
    for (const auto& observable : missing) out << fmt::format("  {}: {}\n", observable.name, observable.absent);
    out << fmt::format("\n{:.3g} s, {:.3g} s of processor time", result.cost.wall_seconds, result.cost.cpu_seconds);
    if (result.program)
        out << fmt::format(", {:.3g} MB\n", 1e-6 * result.program->peak_memory);
    else
        out << fmt::format(", {:.3g} particle steps\n", result.cost.particle_steps);
}

}  // namespace grainsweep::cli
