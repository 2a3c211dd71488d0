#include "sweep/cli/replay.hpp"

#include "sweep/campaign/wrong_question.hpp"
#include "sweep/cli/build_facts.hpp"
#include "sweep/cli/folder_beside.hpp"
#include "sweep/cli/path_option.hpp"
#include "sweep/cli/program_case.hpp"
#include "sweep/cli/stored_case.hpp"
#include "sweep/workers/compute.hpp"
#include "sweep/workers/worker.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <utility>
#include <vector>

namespace grainsweep::cli {
namespace {

using campaign::Outcome;
using report::Format;
using store::Store;
using store::Table;

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
    Table table{{"observable", "archive", "replay", "relative_difference"}, {}};
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
        throw campaign::wrong_question(
            "CASE", request.id,
            "has no result yet, and this program has no checkpoint of it to show: a running case saves one every "
            "minute");
    campaign::CaseResult result;
    result.message = "unfinished: the state of its last checkpoint";
    pictures.finish(result);
    pictures.say(true);
    return 0;
}

}  // namespace

int replay(const ReplayRequest& request, Format format) {
    const Store archive(request.database, Store::Mode::read);
    const campaign::Case as_stored = require_case(archive, request.id);
    const auto program = archive.program(as_stored.scene);
    const campaign::Case question = as_asked_today(as_stored);
    archive.enter_files_of(question);
    const auto stored = archive.result(question.id);
    if (!stored || stored->outcome == Outcome::abandoned) {
        const bool shows = !request.pictures.page.empty() || !request.pictures.folder.empty();
        if (shows && program == nullptr) return show_checkpoint(request, question);
        throw campaign::wrong_question("CASE", request.id, "has no result to compare with yet");
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
        throw campaign::wrong_question("--keep", request.keep, "is for cases of a program only");

    if (program != nullptr)
        std::cerr << fmt::format("grainsweep: runs the stored command of this case: {}\n",
                                 fmt::join(program->command, " "));
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
        report::write(std::cout, report::Json{{"case_id", question.id},
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

}  // namespace grainsweep::cli
