// status, explain, replay, query, dump: contents of the archive.
#include "solver/scenes/scene.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/cli/build_facts.hpp"
#include "sweep/cli/command.hpp"
#include "sweep/cli/compute_options.hpp"
#include "sweep/cli/folder_beside.hpp"
#include "sweep/cli/pictures.hpp"
#include "sweep/cli/program_campaign.hpp"
#include "sweep/cli/progress.hpp"
#include "sweep/cli/query.hpp"
#include "sweep/cli/stored_case.hpp"
#include "sweep/files/artefacts.hpp"
#include "sweep/live/now.hpp"
#include "sweep/report/result.hpp"
#include "sweep/report/results/catalogues.hpp"
#include "sweep/report/results/runs.hpp"
#include "sweep/report/table.hpp"
#include "sweep/report/text_table.hpp"
#include "sweep/store/store.hpp"
#include "sweep/study/history.hpp"
#include "sweep/workers/compute.hpp"
#include "sweep/workers/worker.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace grainsweep::cli {
namespace {

using campaign::Outcome;
using report::Format;
using report::Json;
using report::Result;
namespace results = report::results;
using store::Store;
using store::Table;
using Cell = store::Table::Cell;

struct Arguments {
    std::string database, text;
};

// ---- status -------------------------------------------------------------------------------------------------

std::string counted(std::int64_t count, std::string_view noun) {
    return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

bool is_outcome(const std::string& column) {
    return campaign::outcome_named(column).has_value();
}

/// The value with its unit; empty: not worth a line.
std::string with_unit(const std::string& column, const Cell& cell) {
    if (std::holds_alternative<std::monostate>(cell)) return {};
    const auto* count = std::get_if<std::int64_t>(&cell);
    const auto* number = std::get_if<double>(&cell);
    if (count != nullptr && is_outcome(column)) return *count == 0 ? "" : counted(*count, "case");
    if (count != nullptr && (column == "cases" || column == "waiting")) return counted(*count, "case");
    if (column == "points" || column == "asked_points" || column == "asked_replicates")
        return {};  // shown in other columns
    if (count != nullptr && column == "candidates") return counted(*count, "point") + " of the design";
    if (count != nullptr && column == "dropped")
        return *count == 0 ? "" : counted(*count, "point") + " left out by where";
    if (count != nullptr && column == "replicates")
        return *count == 1 ? "" : counted(*count, "case") + " at each point";
    if (count != nullptr && column == "finished") return counted(*count, "case");
    if (count != nullptr && column == "imported")
        return *count == 0 ? "" : counted(*count, "case") + ", computed elsewhere";
    if (count != nullptr && column == "stopped_at") return fmt::format("converged after {}", counted(*count, "point"));
    if (number != nullptr && column == "rate")
        return fmt::format("{} cases/s in the last run",
                           *number < 1000 ? fmt::format("{:.3g}", *number) : fmt::format("{:.0f}", *number));
    if (number != nullptr && column == "time_left") return *number == 0 ? "0 s" : duration(*number) + " at this rate";
    return report::cell_text(cell);
}

std::string label_of(std::string column) {
    std::ranges::replace(column, '_', ' ');
    return column;
}

/// Writes the rows of Store::status(). Outcomes without a case are left out. Unknown columns are shown with their
/// names.
void write_status(std::ostream& out, const store::Table& status) {
    for (std::size_t row = 0; row < status.rows.size(); ++row) {
        const auto& cells = status.rows[row];
        std::string name, scene;
        std::vector<std::pair<std::string, std::string>> lines;
        std::size_t widest = 0;
        for (std::size_t j = 0; j < cells.size(); ++j) {
            const auto& column = status.columns[j];
            if (column == "campaign") {
                name = report::cell_text(cells[j]);
            } else if (column == "scene") {
                scene = shown_scene(report::cell_text(cells[j]));
            } else if (auto value = with_unit(column, cells[j]); !value.empty()) {
                lines.emplace_back(label_of(column), std::move(value));
                widest = std::max(widest, lines.back().first.size());
            }
        }
        out << fmt::format("{}{}: {}\n", row > 0 ? "\n" : "", name, scene);
        for (const auto& [label, value] : lines) out << fmt::format("  {:<{}}  {}\n", label, widest, value);
    }
}

/// Returns the first `most` running cases, one row each: case, point, each factor, done (0 to 1), seconds, attempt,
/// host.
store::Table running_cases(const store::Store& archive, const live::Now& now, std::size_t most) {
    store::Table table;
    const auto factors = archive.factor_order(now.campaign);
    table.columns = {"case", "point"};
    table.columns.insert(table.columns.end(), factors.begin(), factors.end());
    for (const char* name : {"done", "seconds", "attempt", "host"}) table.columns.emplace_back(name);
    const auto quoted = [](const std::string& name) {
        std::string text = "\"";
        for (const char c : name) text.append(c == '"' ? 2 : 1, c);
        return text += '"';
    };
    std::string columns = "point";
    for (const auto& factor : factors) columns += ", " + quoted(factor);
    const auto held = archive.campaigns();
    if (!std::ranges::count(held, now.campaign, &store::CampaignRecord::name)) return table;
    const auto rows = archive.rows_of(now.campaign);
    for (const auto& one : now.running) {
        if (table.rows.size() == most) break;
        auto& row = table.rows.emplace_back(std::vector<Cell>{one.case_id});
        const auto found = archive.query(
            fmt::format("SELECT {} FROM ({}) WHERE case_id = '{}' ORDER BY point LIMIT 1", columns, rows, one.case_id));
        for (std::size_t k = 0; k <= factors.size(); ++k)
            row.push_back(found.rows.empty() ? Cell{} : found.rows.front()[k]);
        row.push_back(one.share ? Cell{*one.share} : Cell{});
        row.push_back(one.seconds);
        row.push_back(one.attempt);
        row.push_back(one.host);
    }
    return table;
}

/// Writes the state of the run and its running cases.
void write_now(std::ostream& out, const store::Store& archive, const live::Now& now) {
    constexpr std::size_t most_shown = 32;
    out << fmt::format("\na run of {} is under way on {} (process {}): {} of {} cases{}, {}{} left{}\n", now.campaign,
                       now.host, now.process, now.decided, now.questions,
                       now.failed > 0 ? fmt::format(", {} failed", now.failed) : "", now.at_most ? "at most " : "",
                       duration(now.seconds_left), now.judgement.empty() ? "" : "; " + now.judgement);
    if (now.running.empty()) return;
    auto table = running_cases(archive, now, most_shown);
    for (auto& row : table.rows) row[0] = std::get<std::string>(row[0]).substr(0, 12);
    report::write(out, table, report::Format::text);
    if (now.running.size() > most_shown) out << fmt::format("and {} more\n", now.running.size() - most_shown);
}

/// Whether a campaign has converged by its rule, which its counts do not show.
struct Convergence {
    std::optional<bool> converged;  ///< none: no rule
    std::string verdict;
};

Convergence convergence_of(const Store& archive, const store::CampaignRecord& record) {
    if (!record.convergence) return {};
    const auto& observable = record.convergence->observable;
    const auto responses = study::read_response(archive, record, observable);
    const auto history = study::history_of(responses, responses.observable(observable));
    return {history.converged, history.verdict};
}

int status(const Arguments& asked, Format format) {
    const Store archive(asked.database, Store::Mode::read);
    Table table = archive.status();
    const auto records = archive.campaigns();  // one row each, in the same order
    const auto now = live::read_now(asked.database);
    std::vector<Convergence> standings;
    for (const auto& record : records) standings.push_back(convergence_of(archive, record));
    if (format == Format::json) {
        Json rows = Json::array();
        for (std::size_t k = 0; k < standings.size(); ++k) {
            const auto& [converged, verdict] = standings[k];
            Result<results::status> row = {{"converged", converged}, {"verdict", converged ? Json(verdict) : Json()}};
            if (now && now->campaign == records[k].name)
                row.add("running", report::to_json(running_cases(archive, *now, now->running.size())))
                    .add("expected_seconds", now->seconds_left)
                    .add("expected_at_most", now->at_most);
            rows.push_back(report::to_json(table, k).add(row));
        }
        report::write(std::cout, rows);
        return 0;
    }
    const bool text = format == Format::text;
    for (const char* name : {text ? "convergence" : "converged", text ? "extent" : "verdict"})
        table.columns.emplace_back(name);
    for (std::size_t k = 0; k < standings.size(); ++k) {
        const auto& [converged, verdict] = standings[k];
        auto& row = table.rows[k];
        if (text) {
            const auto note = study::extent_note(records[k]);
            row.push_back(converged ? Table::Cell{records[k].convergence->observable + ": " + verdict} : Table::Cell{});
            row.push_back(note.empty() ? Table::Cell{} : Table::Cell{note});
        } else {
            row.push_back(converged ? Table::Cell{std::int64_t{*converged}} : Table::Cell{});
            row.push_back(converged ? Table::Cell{verdict} : Table::Cell{});
        }
    }
    if (text) {
        write_status(std::cout, table);
        if (now) write_now(std::cout, archive, *now);
    } else {
        report::write(std::cout, table, format);
    }
    return 0;
}

// ---- explain ------------------------------------------------------------------------------------------------

/// The campaigns that will not come to it: they converged and stopped before its point. Empty: one of them will.
std::string out_of_reach(const std::vector<store::CasePlace>& places) {
    std::string reason;
    for (const auto& place : places) {
        if (!place.stopped_at || place.point < *place.stopped_at) return {};
        reason = fmt::format("campaign '{}' converged and stopped at {} points, before its point {}", place.campaign,
                             *place.stopped_at, place.point);
    }
    return reason;
}

std::string why_failed(const std::vector<store::LoggedAttempt>& attempts, const std::vector<store::CasePlace>& places) {
    const auto failures = std::ranges::count_if(attempts, [](const auto& attempt) {
        return attempt.outcome == Outcome::crashed || attempt.outcome == Outcome::timed_out;
    });
    std::int64_t limit = 0;
    for (const auto& place : places) limit = std::max(limit, place.attempts.value_or(campaign::Limits{}.attempts));
    if (failures < limit)
        return fmt::format("{} of its attempts failed; limits.attempts is {}: the next run tries it again", failures,
                           limit);
    return fmt::format(
        "{} of its attempts failed; limits.attempts is {}: it will not run again; to rerun it, raise the limit or use "
        "`run --again {}`",
        failures, limit, to_string(*attempts.back().outcome));
}

/// `impossible`: why this program cannot compute the case; empty: it can.
std::string why(const std::vector<store::LoggedAttempt>& attempts, const std::vector<store::CasePlace>& places,
                const std::optional<campaign::CaseResult>& stands, const std::string& impossible) {
    if (stands && campaign::settles(stands->outcome) && attempts.back().number != stands->attempt.number)
        return fmt::format(
            "settled: the result of attempt {} is kept, because later attempts gave none; `run "
            "--again {}` reruns it",
            stands->attempt.number, to_string(stands->outcome));
    if (stands && stands->imported && campaign::settles(stands->outcome))
        return fmt::format(
            "settled: it was computed elsewhere and imported from '{}', line {}; its seed is not the one of that "
            "computation; `run --again {}` computes it here if a design has it",
            stands->imported->file, stands->imported->line, to_string(stands->outcome));
    const std::string passed_by = out_of_reach(places);
    const auto next_run = [&](const std::string& does) {
        if (!impossible.empty()) return fmt::format("this program does not run it: it {}", impossible);
        return passed_by.empty() ? does : fmt::format("it will not run: {}", passed_by);
    };
    if (attempts.empty())
        return passed_by.empty() ? next_run("it has not started: the next run of its campaign starts it")
                                 : fmt::format("it has not started and will not: {}", passed_by);
    const auto& last = attempts.back();
    if (!last.outcome)
        return next_run("its last attempt is running, or its main process died: the next run starts it again");
    switch (*last.outcome) {
        case Outcome::completed:
        case Outcome::skipped:
            return "settled: it will not run again, because the same inputs give the same result";
        case Outcome::unstable:
        case Outcome::rejected:
            return fmt::format(
                "settled: it will not run again, because the same inputs end the same way; `run --again {}` reruns it",
                to_string(*last.outcome));
        case Outcome::abandoned:
            return next_run("it was interrupted: the next run continues it, from its checkpoint if there is one");
        case Outcome::crashed:
        case Outcome::timed_out:
            break;
    }
    return next_run(why_failed(attempts, places));
}

std::string described_build(const campaign::Computer& by) {
    const std::string id = by.build.empty() ? "" : " " + by.build.substr(0, 12);
    return fmt::format("{} ({}){}", by.version, by.commit, id);
}

Table attempts_table(const std::vector<store::LoggedAttempt>& attempts) {
    Table table{{"attempt", "outcome", "started", "wall_seconds", "threads", "host", "processor", "instruction_path",
                 "build", "message"},
                {}};
    for (const auto& attempt : attempts) {
        table.rows.push_back({attempt.number,
                              attempt.outcome ? std::string(to_string(*attempt.outcome)) : std::string("running"),
                              attempt.started, report::to_cell(attempt.wall_seconds), report::to_cell(attempt.threads),
                              attempt.computer.host, attempt.computer.processor, attempt.computer.instruction_path,
                              described_build(attempt.computer), attempt.message});
    }
    if (std::ranges::none_of(attempts, [](const auto& one) { return one.program.has_value(); })) return table;
    // Of a program, in the place of the path that the solver's loops take.
    *std::ranges::find(table.columns, "instruction_path") = "program_version";
    table.columns.insert(table.columns.end() - 1, {"peak_memory", "exit_status"});
    for (std::size_t k = 0; k < attempts.size(); ++k) {
        auto& row = table.rows[k];
        const auto& program = attempts[k].program;
        const bool versioned = program && !program->version.empty();
        row[7] = versioned ? Table::Cell{program->version} : Table::Cell{};
        row.insert(row.end() - 1, {program ? report::to_cell(program->peak_memory) : Table::Cell{},
                                   program ? report::to_cell(program->exit_status) : Table::Cell{}});
    }
    return table;
}

Table files_table(const std::vector<store::StoredFile>& files) {
    Table table{report::columns_of(results::stored_files), {}};
    for (const auto& file : files)
        table.rows.push_back({file.name, file.place, report::to_cell(file.bytes), file.hash});
    return table;
}

int explain(const Arguments& asked, Format format) {
    const Store archive(asked.database, Store::Mode::read);
    const campaign::Case question = require_case(archive, asked.text);
    const auto attempts = archive.attempts(question.id);
    const Table table = attempts_table(attempts);
    std::string reason =
        why(attempts, archive.places(question.id), archive.result(question.id), why_not_again(question));
    const auto others = workers::checkpoints_of_others(
        files::ArtefactFolder(folder_beside(asked.database, of_artefacts)), this_computer(), false);
    if (const auto other = others.find(question.id); other != others.end() && !archive.is_settled(question.id))
        reason += fmt::format("; with this program it starts {}", other->second);
    if (format == Format::csv) {
        report::write(std::cout, table, format);
        return 0;
    }
    if (format == Format::json) {
        report::write(std::cout, Result<results::explain>{
                                     {"case_id", question.id},
                                     {"scene", question.scene},
                                     {"revision", question.revision},
                                     {"seed", report::to_json(Table::Cell{static_cast<std::int64_t>(question.seed)})},
                                     {"inputs", report::to_json(question.inputs)},
                                     {"files", report::to_json(files_table(archive.files_of(question.id)))},
                                     {"attempts", report::to_json(table)},
                                     {"why", reason}});
        return 0;
    }
    std::cout << fmt::format("{}\nscene {} revision {}, seed {}\n", heading_of(archive, question.id),
                             shown_scene(question.scene), question.revision, question.seed);
    if (const auto result = archive.result(question.id))
        if (const auto origin = origin_of(archive, *result))
            std::cout << fmt::format("answer adopted from case {}, computed with seed {}\n", origin->id, origin->seed);
    const auto scene = find_scene(question.scene);
    for (const auto& [name, value] : question.inputs) {
        const auto* parameter = scene == nullptr ? nullptr : scene->find_parameter(name);
        if (parameter != nullptr && parameter->default_value == value) continue;
        std::cout << fmt::format("  {} = {}\n", name, campaign::to_text(value));
    }
    std::cout << '\n';
    if (const auto files = files_table(archive.files_of(question.id)); !files.rows.empty()) {
        report::write(std::cout, files, format);
        std::cout << '\n';
    }
    report::write(std::cout, table, format);
    std::cout << '\n' << reason << '\n';
    return 0;
}

// ---- replay -------------------------------------------------------------------------------------------------

struct ReplayRequest {
    std::string database, id;  ///< `id`: id of the case, or its beginning
    PictureRequest pictures;
    std::string path;                 ///< instruction path; empty: as stored
    std::optional<double> tolerance;  ///< relative; empty: equal bits if they can be expected
    std::string keep;                 ///< folder for the case of a program
    std::int64_t threads = 0;         ///< 0: one for each core of the job
};

/// Returns whether sources and instruction path are the same. If the sources are unknown or have changes of their own,
/// the executable must be the same.
bool gives_the_same_bits(const campaign::Computer& a, const campaign::Computer& b) {
    const bool known = a.commit != "unknown" && !a.commit.ends_with("-modified");
    return a.version == b.version && a.commit == b.commit && a.instruction_path == b.instruction_path &&
           (known || (!a.build.empty() && a.build == b.build));
}

// Within one build and instruction path a case repeats bit for bit. Elsewhere rounding differs, and a
// granular flow forgets its rounding within a fraction of a second: only its statistics can be compared.
constexpr double tolerance_across_paths = 0.1;

double relative_difference(double a, double b) {
    if (a == b || (std::isnan(a) && std::isnan(b))) return 0;
    return std::abs(a - b) / std::max(std::abs(a), std::abs(b));
}

double at(const std::map<std::string, double, std::less<>>& scalars, const std::string& name) {
    const auto found = scalars.find(name);
    return found == scalars.end() ? std::nan("") : found->second;
}

/// Returns the largest relative difference of a series; NaN if lengths differ, or if only one of two values is NaN.
double largest_difference(const auto& a, const auto& b, const std::string& name) {
    static const std::vector<Sample> none;
    const auto of = [&](const auto& series) -> const std::vector<Sample>& {
        const auto found = series.find(name);
        return found == series.end() ? none : found->second;
    };
    const auto &x = of(a), &y = of(b);  // an empty series is as good as none
    if (x.size() != y.size()) return std::nan("");
    double worst = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
        for (const double one : {relative_difference(x[k].time, y[k].time), relative_difference(x[k].bin, y[k].bin),
                                 relative_difference(x[k].value, y[k].value)})
            worst = std::isnan(one) ? one : std::max(worst, one);
        if (std::isnan(worst)) break;
    }
    return worst;
}

/// Expected agreement of a replay.
struct Expectation {
    double tolerance = 0;       ///< relative; 0: the same bits
    bool everything = true;     ///< also series, and values that the archive does not have
    std::string why_tolerated;  ///< in brackets behind the difference
};

struct Comparison {
    Table table{report::columns_of(results::compared_scalar), {}};
    bool agrees = false;
    std::string verdict;
};

Comparison compared(const campaign::CaseResult& stored, const campaign::CaseResult& now, const Expectation& expected) {
    Comparison comparison;
    double worst = 0;
    const auto take = [&](double difference) { worst = std::isnan(difference) ? 1 : std::max(worst, difference); };
    auto names = stored.observations.scalars;
    if (expected.everything) names.insert(now.observations.scalars.begin(), now.observations.scalars.end());
    for (const auto& [name, ignored] : names) {  // another build may measure more than the archive knows
        const double a = at(stored.observations.scalars, name), b = at(now.observations.scalars, name);
        const double difference = relative_difference(a, b);
        take(difference);
        comparison.table.rows.push_back({name, report::to_cell(a), report::to_cell(b), report::to_cell(difference)});
    }
    if (expected.everything) {
        auto series = stored.observations.series;
        series.insert(now.observations.series.begin(), now.observations.series.end());
        for (const auto& [name, ignored] : series)
            take(largest_difference(stored.observations.series, now.observations.series, name));
    }
    const bool same_outcome = stored.outcome == now.outcome;
    comparison.agrees = same_outcome && worst <= expected.tolerance;
    comparison.verdict =
        !same_outcome ? fmt::format("stored outcome {}, replayed outcome {}: {}", to_string(stored.outcome),
                                    to_string(now.outcome), now.message)
        : expected.tolerance == 0
            ? (comparison.agrees ? "equal to the last bit" : "DIFFERENT although " + expected.why_tolerated)
            : fmt::format("largest relative difference {:.3g} ({}up to {} counts as agreement)", worst,
                          expected.why_tolerated.empty() ? "" : expected.why_tolerated + ": ", expected.tolerance);
    return comparison;
}

/// With another build or instruction path only scalars are compared.
Expectation expectation_of(const ReplayRequest& request, const campaign::Program* program, bool same_path) {
    if (program != nullptr) {
        const double tolerance = request.tolerance.value_or(program->tolerance);
        return {tolerance, true,
                tolerance == 0 ? "no tolerance is given (--tolerance, or \"tolerance\" of the program)" : ""};
    }
    if (request.tolerance)
        return {*request.tolerance, same_path, same_path ? "build and instruction path are the same" : ""};
    if (same_path) return {0, true, "build and instruction path are the same"};
    return {tolerance_across_paths, false, "another build or instruction path"};
}

/// Shows an unfinished case in the state of its checkpoint: of a running case, at most a minute old.
int show_checkpoint(const ReplayRequest& request, const campaign::Case& question) {
    Pictures pictures(request.pictures, question);
    if (!workers::shoot_checkpoint(question, folder_beside(request.database, of_artefacts), this_computer(),
                                   pictures.camera()))
        throw campaign::input_error(
            "CASE", request.id,
            "has no result yet, and this program has no checkpoint of it to show: a running case saves one every "
            "minute");
    campaign::CaseResult result;
    result.message = "unfinished: the state of its last checkpoint";
    pictures.finish(result);
    pictures.say(true);
    return 0;
}

/// Runs the command and returns the exit code: 0 if both agree. Of a case without an answer it only takes the requested
/// pictures, of its checkpoint. Throws InputError if there is no stored answer and no picture.
int replay(const ReplayRequest& request, Format format) {
    const Store archive(request.database, Store::Mode::read);
    const campaign::Case as_stored = require_case(archive, request.id);
    const auto program = archive.program(as_stored.scene);
    campaign::Case question = as_asked_today(as_stored);
    archive.enter_files_of(question);
    const auto stored = archive.result(question.id);
    if (!stored || stored->outcome == Outcome::abandoned) {
        const bool shows = request.pictures.any();
        if (shows && program == nullptr) return show_checkpoint(request, question);
        throw campaign::input_error("CASE", request.id, "has no result to compare with yet");
    }
    if (stored->outcome == Outcome::crashed || stored->outcome == Outcome::timed_out)
        std::cerr << fmt::format("grainsweep: this case {}; it may do the same here\n",
                                 stored->outcome == Outcome::crashed ? "crashed its worker" : "ran out of time");
    const auto attempts = archive.attempts(question.id);
    const auto then = std::ranges::find(attempts, stored->attempt.number, &store::LoggedAttempt::number);
    if (!request.path.empty())
        use_path(request.path);
    else if (then != attempts.end())
        use_path_of_old(then->computer.instruction_path);
    const bool same_path = then != attempts.end() && gives_the_same_bits(then->computer, this_computer());
    if (program == nullptr && !request.keep.empty())
        throw campaign::input_error("--keep", request.keep, "is for cases of a program only");

    if (program != nullptr)
        std::cerr << fmt::format("grainsweep: runs the stored command of this case: {}\n",
                                 fmt::join(program->command, " "));
    if (const auto origin = origin_of(archive, *stored); origin && program != nullptr) {
        question.seed = origin->seed;
        std::cerr << fmt::format("grainsweep: with seed {}, because the answer is adopted from case {}\n", origin->seed,
                                 origin->id);
    }
    Pictures pictures(request.pictures, question);
    const auto now = [&] {
        if (program != nullptr)
            return answer_by_program(program, question, stored->attempt.number, std::nullopt, request.keep,
                                     request.pictures);
        NoArtefacts artefacts;
        auto computed = workers::compute(
            question, stored->attempt.number, artefacts, std::nullopt, [](const Scene&) { return true; },
            pictures.camera());
        return std::move(computed.value());  // nothing gave it up
    }();
    pictures.finish(now);
    const auto [table, agrees, verdict] = compared(*stored, now, expectation_of(request, program.get(), same_path));
    if (format == Format::json) {
        report::write(std::cout, Result<results::replay>{{"case_id", question.id},
                                                         {"same_path", same_path},
                                                         {"agrees", agrees},
                                                         {"verdict", verdict},
                                                         {"scalars", report::to_json(table)}});
    } else {
        if (format == Format::text) std::cout << heading_of(archive, question.id) << "\n\n";
        if (!table.rows.empty()) report::write(std::cout, table, format);
        if (format == Format::text) std::cout << '\n' << verdict << '\n';
    }
    pictures.say(format == Format::text);
    return agrees ? 0 : 1;
}

// ---- options ------------------------------------------------------------------------------------------------

/// DB.
void declare_database(Parser& parser, Arguments& asked) {
    parser.add_option("DB", asked.database, "database");
}

void declare_case(Parser& parser, Arguments& asked) {
    declare_database(parser, asked);
    parser.add_option("CASE", asked.text, "case id, or its beginning");
}

void declare_replay(Parser& parser, ReplayRequest& request) {
    parser.add_option("DB", request.database, "database");
    parser.add_option("CASE", request.id, "case id, or its beginning");
    parser.add_option(
        "--tolerance X", request.tolerance,
        "relative difference that counts as agreement; default: 0 on the same build and instruction path; "
        "for a program its \"tolerance\"");
    parser.add_option("--keep DIR", request.keep, "new folder in which a program computes the case; it is kept");
    declare_pictures(parser, request.pictures);
    declare_path(parser, request.path, "that of the stored case");
    declare_threads(parser, request.threads);
}

int replay_checked(const ReplayRequest& request, Format format) {
    use_threads(request.threads);
    if (const auto tolerance = request.tolerance; tolerance && !(*tolerance >= 0 && *tolerance <= 1))
        throw campaign::input_error("--tolerance", std::to_string(*tolerance), "a number from 0 to 1");
    return replay(request, format);
}

void declare_query(Parser& parser, QueryRequest& request) {
    parser.add_option("DB", request.database, "database");
    parser.add_option("SQL", request.sql, "the statement; every campaign is a view of its name");
    parser.add_option("-o,--output FILE.xlsx", request.output, "with --format xlsx: workbook to write");
    parser.add_option("--limit-seconds SECONDS", request.seconds, "limit of processor time, s; 0: none; default: 600");
}

int dump(const Arguments& asked, Format format) {
    const Store archive(asked.database, Store::Mode::read);
    if (format == Format::text) {
        archive.dump([](std::string_view line) { std::cout << line << '\n'; });
        return 0;
    }
    report::RowWriter rows(std::cout, format);
    rows.begin(report::columns_of(results::dump_line));
    archive.dump([&](std::string_view line) { rows.add({std::string(line)}); });
    rows.end();
    return 0;
}

}  // namespace

std::vector<Command> archive_commands() {
    return {
        command<Arguments>("status", "shows cases by outcome, rate, time left and convergence", declare_database,
                           status),
        command<Arguments>("explain", "lists the attempts of a case; states why it will or will not run again",
                           declare_case, explain),
        command<ReplayRequest>("replay",
                               "computes a stored case again and compares; runs the stored command of a program",
                               declare_replay, replay_checked),
        with_workbook(command<QueryRequest>("query", "runs one read-only SQL statement", declare_query, query)),
        verbatim(command<Arguments>("dump", "prints all results as canonical text; equal results give equal text",
                                    declare_database, dump)),
    };
}

}  // namespace grainsweep::cli
