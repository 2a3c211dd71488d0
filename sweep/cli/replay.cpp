#include "sweep/cli/replay.hpp"

#include "sweep/campaign/wrong_question.hpp"
#include "sweep/cli/build_facts.hpp"
#include "sweep/cli/path_option.hpp"
#include "sweep/cli/stored_case.hpp"
#include "sweep/workers/compute.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <string>

namespace grainsweep::cli {
namespace {

using campaign::Outcome;
using report::Format;
using store::Store;
using store::Table;

/// Same sources and instruction path; where the sources have changes of their own or are unknown, the same executable.
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

/// Equal to the last bit; an empty series is as good as none.
bool same_samples(const auto& a, const auto& b, const std::string& name) {
    static const std::vector<Sample> none;
    const auto of = [&](const auto& series) -> const std::vector<Sample>& {
        const auto found = series.find(name);
        return found == series.end() ? none : found->second;
    };
    return std::ranges::equal(of(a), of(b), [](const Sample& x, const Sample& y) {
        return relative_difference(x.time, y.time) == 0 && relative_difference(x.bin, y.bin) == 0 &&
               relative_difference(x.value, y.value) == 0;
    });
}

struct Comparison {
    Table table{{"observable", "archive", "replay", "relative_difference"}, {}};
    bool agrees = false;
    std::string verdict;
};

/// `same_path`: the same bits are expected, and everything the replay measured is compared.
Comparison compared(const campaign::CaseResult& stored, const campaign::CaseResult& now, bool same_path) {
    Comparison comparison;
    double worst = 0;
    auto names = stored.observations.scalars;
    if (same_path) names.insert(now.observations.scalars.begin(), now.observations.scalars.end());
    for (const auto& [name, ignored] : names) {  // another build may measure more than the archive knows
        const double a = at(stored.observations.scalars, name), b = at(now.observations.scalars, name);
        const double difference = relative_difference(a, b);
        worst = std::isnan(difference) ? 1 : std::max(worst, difference);
        comparison.table.rows.push_back({name, report::to_cell(a), report::to_cell(b), report::to_cell(difference)});
    }
    bool same_series = true;
    auto series = stored.observations.series;
    series.insert(now.observations.series.begin(), now.observations.series.end());
    for (const auto& [name, ignored] : series)
        same_series = same_series && same_samples(stored.observations.series, now.observations.series, name);
    const bool same_outcome = stored.outcome == now.outcome;
    comparison.agrees = same_outcome && (same_path ? worst == 0 && same_series : worst <= tolerance_across_paths);
    comparison.verdict = !same_outcome ? fmt::format("the archive says {}, the replay {}: {}",
                                                     to_string(stored.outcome), to_string(now.outcome), now.message)
                         : same_path
                             ? (comparison.agrees ? "equal to the last bit"
                                                  : "DIFFERENT although build and instruction path are the same")
                             : fmt::format(
                                   "largest relative difference {:.3g} (another build or instruction path: up to {} is "
                                   "taken as agreement)",
                                   worst, tolerance_across_paths);
    return comparison;
}

}  // namespace

int replay(const std::string& database, const std::string& id, const PictureRequest& wanted, const std::string& path,
           Format format) {
    const Store archive(database, Store::Mode::read);
    const campaign::Case question = as_asked_today(require_case(archive, id));
    const auto stored = archive.result(question.id);
    if (!stored) throw campaign::wrong_question("CASE", id, "has no result to compare with yet");
    if (stored->outcome == Outcome::abandoned)
        throw campaign::wrong_question("CASE", id, "was given back unfinished: there is no answer to compare with yet");
    if (stored->outcome == Outcome::crashed || stored->outcome == Outcome::timed_out)
        std::cerr << fmt::format("grainsweep: this case {}; computed here it may do the same\n",
                                 stored->outcome == Outcome::crashed ? "crashed its worker" : "ran out of time");
    const auto attempts = archive.attempts(question.id);
    const auto then = std::ranges::find(attempts, stored->attempt.number, &store::LoggedAttempt::number);
    if (!path.empty())
        use_path(path);
    else if (then != attempts.end())
        use_path_of_old(then->computer.instruction_path);
    const bool same_path = then != attempts.end() && gives_the_same_bits(then->computer, this_computer());

    NoArtefacts artefacts;
    Pictures pictures(wanted, question);
    const auto now = workers::compute(
        question, stored->attempt.number, artefacts, std::nullopt, [](const Scene&) { return true; },
        pictures.camera());
    pictures.finish(now.value());  // nothing gave it up
    const auto [table, agrees, verdict] = compared(*stored, *now, same_path);
    if (format == Format::json) {
        report::write(std::cout, nlohmann::ordered_json{{"case_id", question.id},
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
