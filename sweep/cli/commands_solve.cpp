// solve: one case of a campaign in this process, without a database.
#include "solver/scenes/scene.hpp"
#include "sweep/campaign/forecast.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/machine.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/cli/asked_case.hpp"
#include "sweep/cli/command.hpp"
#include "sweep/cli/compute_options.hpp"
#include "sweep/cli/pictures.hpp"
#include "sweep/cli/program_campaign.hpp"
#include "sweep/report/main_observables.hpp"
#include "sweep/report/next_command.hpp"
#include "sweep/report/print_axes.hpp"
#include "sweep/report/result.hpp"
#include "sweep/report/results/runs.hpp"
#include "sweep/workers/compute.hpp"
#include "sweep/workers/memory_room.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <set>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace grainsweep::cli {
namespace {

using campaign::Campaign;
using campaign::CaseResult;
using campaign::Outcome;
using report::Format;
using report::Json;
using report::Result;
namespace results = report::results;
using Cell = store::Table::Cell;

constexpr std::size_t most_inputs = 6;

/// Returns the value as the user would write it: "5.55 mm", "jkr", the number of a count.
std::string input_text(const ParameterSpec& parameter, const Value& value) {
    const auto* real = std::get_if<double>(&value);
    return real != nullptr ? report::quantity_text(*real, parameter.unit) : campaign::to_text(value);
}

/// Returns the scalars that the scene declares and a completed case has no value of.
std::vector<ObservableSpec> absent(const campaign::Case& question, const CaseResult& result) {
    std::vector<ObservableSpec> missing;
    if (result.outcome != Outcome::completed) return missing;
    for (const auto& observable : find_scene(question.scene)->observables)
        if (observable.shape == Shape::scalar && !result.observations.scalars.contains(observable.name))
            missing.push_back(observable);
    return missing;
}

/// Writes the named inputs and the main observables, in at most 20 lines.
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

/// Writes every input that differs from its default and every observable, with its meaning.
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

struct SolveRequest {
    std::string config;
    std::vector<std::string> settings;  ///< NAME=VALUE
    PictureRequest pictures;
    std::string keep;                   ///< folder that a program's case is answered in; empty: none
    std::string path;                   ///< instruction path; empty: the widest there is
    std::int64_t threads = 0;           ///< 0: one for each core
    bool all = false;                   ///< the text has every observable and input
    std::optional<std::uint64_t> seed;  ///< the case's own; none: the campaign's for this question
};

/// Shows the progress in percent if standard error is a terminal.
bool show_progress(const Scene& scene) {
    static const bool terminal = ::isatty(STDERR_FILENO) == 1;
    if (terminal) std::fputs(fmt::format("\r{:3.0f} %", 100 * scene.progress()).c_str(), stderr);
    return true;
}

CaseResult answer_of(const AskedCase& asked, const SolveRequest& request, Pictures& pictures) {
    if (auto program = campaign::known_program(asked.question.scene))
        return answer_by_program(std::move(program), asked.question, 1, asked.limit_seconds, request.keep,
                                 request.pictures);
    if (!request.keep.empty()) throw campaign::input_error("--keep", request.keep, "is for cases of a program only");
    NoArtefacts artefacts;
    auto computed = workers::compute(asked.question, 1, artefacts, std::nullopt, show_progress, pictures.camera());
    return std::move(computed.value());  // the watch never gives it up
}

Json sample_json(const Sample& sample) {
    Result<results::sample> object;
    if (!std::isnan(sample.time)) object.add("time", sample.time);
    if (!std::isnan(sample.bin)) object.add("bin", sample.bin);
    return object.add("value", sample.value);
}

/// Those the scene declares, then others; null: undefined in this case.
Json scalars_of(const campaign::Case& question, const CaseResult& result) {
    const auto& measured = result.observations.scalars;
    Json scalars = Json::object();
    std::set<std::string> declared;
    if (result.outcome == Outcome::completed || result.outcome == Outcome::skipped)
        for (const auto& observable : find_scene(question.scene)->observables) {
            if (observable.shape != Shape::scalar) continue;
            const auto found = measured.find(observable.name);
            scalars.add(observable.name, found == measured.end() ? Json() : Json(found->second));
            declared.insert(observable.name);
        }
    for (const auto& [name, value] : measured)
        if (!declared.contains(name)) scalars.add(name, value);
    return scalars;
}

Json answer_json(const campaign::Case& question, const CaseResult& result) {
    Json missing = Json::object(), series = Json::object(), phases = Json::object();
    for (const auto& observable : absent(question, result)) missing.add(observable.name, observable.absent);
    for (const auto& [name, samples] : result.observations.series) series.add(name, Json::list(samples, sample_json));
    for (const auto& [name, seconds] : result.cost.phases) phases.add(name, seconds);
    Result<results::solve> object = {{"scene", question.scene},
                                     {"revision", question.revision},
                                     {"case_id", question.id},
                                     {"seed", report::to_json(Cell{static_cast<std::int64_t>(question.seed)})}};
    if (result.program)
        object.add("program", Result<results::solved_program>{{"version", result.program->version},
                                                              {"peak_memory", result.program->peak_memory},
                                                              {"exit_status", result.program->exit_status}});
    else
        object.add("instruction_path", instruction_path());
    return object.add(
        Result<results::solve>{{"inputs", report::to_json(question.inputs)},
                               {"outcome", campaign::to_string(result.outcome)},
                               {"message", result.message},
                               {"scalars", scalars_of(question, result)},
                               {"absent", missing},
                               {"series", series},
                               {"cost", Result<results::cost>{{"wall_seconds", result.cost.wall_seconds},
                                                              {"cpu_seconds", result.cost.cpu_seconds},
                                                              {"particle_steps", result.cost.particle_steps},
                                                              {"threads", result.cost.threads},
                                                              {"phases", phases}}}});
}

/// Prints the case: what most users need, or with --all everything.
void print_case(const AskedCase& asked, const SolveRequest& request, const CaseResult& result) {
    if (request.all)
        write_whole_case(std::cout, asked.question, result);
    else
        write_main_case(std::cout, asked.question, asked.shown_inputs, result);
}

/// Suggests the next command.
void say_next(const AskedCase& asked, const SolveRequest& request, const CaseResult& result) {
    const auto config = report::shell_word(request.config);
    const bool answered = result.outcome == Outcome::completed || result.outcome == Outcome::skipped;
    if (answered)
        std::cout << fmt::format("every observable and input, with its meaning: {}\n",
                                 report::next_command(fmt::format("solve {} --all", config)));
    if (!asked.campaign.empty())
        std::cout << fmt::format("all cases of the campaign: {}\n", report::next_command("run " + config));
    else if (answered)
        std::cout << fmt::format("its walls and motions: {}\n",
                                 report::next_command(fmt::format("draw {} -o drawing.html", config)));
}

/// Returns all results in one table: kind (input, outcome, scalar, series, cost), name, place, value.
store::Table table_of(const campaign::Case& question, const CaseResult& result) {
    store::Table table{{"kind", "name", "time", "bin", "value"}, {}};
    const auto add = [&table](const char* kind, const std::string& name, Cell value) {
        table.rows.push_back({std::string(kind), name, Cell{}, Cell{}, std::move(value)});
    };
    for (const auto& [name, value] : question.inputs) add("input", name, report::to_cell(value));
    add("outcome", "outcome", std::string(campaign::to_string(result.outcome)));
    if (!result.message.empty()) add("outcome", "message", result.message);
    for (const auto& [name, value] : result.observations.scalars) add("scalar", name, report::to_cell(value));
    for (const auto& observable : absent(question, result)) add("absent", observable.name, observable.absent);
    for (const auto& [name, samples] : result.observations.series) {
        for (const auto& sample : samples) {
            table.rows.push_back({std::string("series"), name, report::to_cell(sample.time),
                                  report::to_cell(sample.bin), report::to_cell(sample.value)});
        }
    }
    add("cost", "wall_seconds", result.cost.wall_seconds);
    add("cost", "cpu_seconds", result.cost.cpu_seconds);
    add("cost", "particle_steps", result.cost.particle_steps);
    add("cost", "threads", report::to_cell(result.cost.threads));
    for (const auto& [name, seconds] : result.cost.phases) add("cost", name, seconds);
    return table;
}

int solve(const SolveRequest& request, Format format) {
    use_path(request.path);
    use_threads(request.threads);
    const AskedCase asked = asked_case(request.config, request.settings, request.seed);
    const auto& question = asked.question;
    const auto predicted = campaign::predict(*find_scene(question.scene), question.inputs);
    campaign::asked_in(request.config,
                       [&] { campaign::require_memory("this case", predicted.cost.bytes, workers::memory_room()); });
    for (const auto& warning : predicted.warnings)
        std::cerr << fmt::format("warning: {}: {}\n", warning.kind, warning.sentence);
    Pictures pictures(request.pictures, question);
    const CaseResult result = answer_of(asked, request, pictures);
    if (::isatty(STDERR_FILENO) == 1) std::fputs("\r\033[K", stderr);
    pictures.finish(result);
    if (format == Format::text) print_case(asked, request, result);
    if (format == Format::csv) report::write(std::cout, table_of(question, result), format);
    if (format == Format::json) report::write(std::cout, answer_json(question, result));
    pictures.say(format == Format::text);
    if (format == Format::text && !request.all) say_next(asked, request, result);
    return result.outcome == Outcome::completed || result.outcome == Outcome::skipped ? 0 : 1;
}

}  // namespace

std::vector<Command> solve_commands() {
    const auto arguments = [](Parser& parser, SolveRequest& request) {
        parser.add_option("CONFIG", request.config, "campaign file, machine file, or the name of an installed machine");
        parser
            .add_option("--set NAME=VALUE", request.settings,
                        "value of a parameter, a number with or without a unit, or a word; other factors take the "
                        "middle of their range, or their first level")
            ->allow_extra_args(false);
        parser
            .add_option("--seed N", request.seed,
                        "seed of the case, as other commands print it; default: as in the campaign")
            ->check(whole_number(0))
            ->grouped_digits();
        declare_pictures(parser, request.pictures);
        parser.add_option("--keep DIR", request.keep, "new folder in which a program computes the case; it is kept");
        parser.add_flag("--all", request.all,
                        "print every observable and input with its meaning, not only the main ones");
        declare_path(parser, request.path);
        declare_threads(parser, request.threads);
    };
    return {command<SolveRequest>(
        "solve", "computes one case of a campaign or machine in this process, without a database", arguments, solve)};
}

}  // namespace grainsweep::cli
