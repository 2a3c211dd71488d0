#include "sweep/report/summary.hpp"

#include "sweep/report/file_size.hpp"
#include "sweep/report/findings.hpp"
#include "sweep/report/main_observables.hpp"
#include "sweep/report/next_command.hpp"
#include "sweep/study/error_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grainsweep::report {

using namespace study;

namespace {

constexpr std::size_t extremes_in_text = 3, extremes_in_main_text = 1;

std::vector<const ResponseColumn*> main_first(const Responses& responses) {
    std::vector<const ResponseColumn*> order;
    const auto* main = responses.main_observable();
    if (main != nullptr) order.push_back(main);
    for (const auto& response : responses.observables)
        if (&response != main) order.push_back(&response);
    return order;
}

void add_extreme(store::Table& table, const Responses& responses, const ResponseColumn& response, std::size_t row,
                 const std::string& rank) {
    std::vector<store::Table::Cell> cells = {rank, responses.points[row]};
    if (responses.campaign.replicates > 1) cells.emplace_back(responses.replicates[row]);
    for (const auto& factor : responses.factors) {
        if (factor.continuous()) {
            cells.push_back(to_cell(factor.values[row]));
        } else {
            cells.emplace_back(factor_text(factor, row));
        }
    }
    cells.push_back(to_cell(response.values[row]));
    if (!responses.case_ids.empty()) cells.emplace_back(responses.case_ids[row]);
    table.rows.push_back(std::move(cells));
}

std::string moments_heading(const Responses& responses, const History& history, std::string_view what) {
    if (!history.provisional) return fmt::format("{} of {} points, 95 % errors", what, responses.counted_points());
    return fmt::format(
        "provisional {} of all {} finished cases, 95 % errors; the settled beginning has {} points, and only that is "
        "judged",
        what, responses.finished(), responses.counted_points());
}

/// Mean and standard deviation of the main observables, with their meaning.
store::Table main_moments(const Responses& responses, const std::vector<MainObservable>& shown) {
    store::Table table{{"observable", "unit", "mean", "sd", "meaning"}, {}};
    for (const auto& one : shown) {
        const auto& response = responses.observable(one.name);
        const auto history = figures_of(responses, response);
        const auto& all = history.provisional ? *history.provisional : history.all;
        const auto text = [&](stats::Statistic statistic) {
            return with_error(all.of(statistic).value, all.of(statistic).error);
        };
        table.rows.push_back({one.name, response.unit == "1" ? "" : response.unit, text(stats::Statistic::mean),
                              text(stats::Statistic::sd), one.words});
    }
    return table;
}

/// The observable whose extremes are shown: the deciding one, else the first main one with a value.
const ResponseColumn& leading(const Responses& responses, const std::vector<MainObservable>& shown) {
    if (const auto* deciding = responses.deciding_observable()) return *deciding;
    for (const auto& one : shown) {
        const auto& response = responses.observable(one.name);
        if (std::ranges::any_of(response.values, [](double x) { return std::isfinite(x); })) return response;
    }
    return *responses.main_observable();
}

void show_all_moments(Document& shown, const Responses& responses, const History& history) {
    shown.say()
        .say(moments_heading(responses, history, "moments"))
        .show(moments_table(responses))
        .say()
        .show(extremes_table(responses, *responses.main_observable(), extremes_in_text));
}

void show_main_moments(Document& shown, const Responses& responses, const History& history) {
    const auto names = main_observables(responses);
    shown.say()
        .say(moments_heading(responses, history, "mean and standard deviation"))
        .show(main_moments(responses, names))
        .say()
        .show(extremes_table(responses, leading(responses, names), extremes_in_main_text));
    const auto others = responses.observables.size() - names.size();
    shown.say(fmt::format("{}skewness and kurtosis: run again with --all",
                          others == 0 ? "" : fmt::format("{} other observables, ", others)));
}

}  // namespace

std::string provisional_line(const History& history) {
    if (!history.provisional) return {};
    std::string line =
        fmt::format("provisional, over all finished cases ({} values), not judged:", history.provisional->count);
    for (const auto statistic : stats::statistics) {
        const auto& known = history.provisional->of(statistic);
        line += fmt::format("{} {} {}", line.ends_with(':') ? "" : ",", to_string(statistic),
                            with_error(known.value, known.error));
    }
    return line;
}

std::string outcome_line(const Responses& responses) {
    std::string line;
    for (const auto& [outcome, count] : count_outcomes(responses)) {
        if (count > 0) line += fmt::format("{}{} {}", line.empty() ? "" : ", ", count, outcome);
    }
    return line.empty() ? "no cases" : line;
}

std::string study_heading(const Responses& responses, const ResponseColumn& response) {
    const auto& record = responses.campaign;
    const bool sequences = record.sequences > 1 && repeats(responses);
    return fmt::format("{}: {} over {} points of a {} design{}; {}", record.name,
                       with_unit(response.name, response.unit), responses.counted_points(), record.design,
                       sequences ? fmt::format(" of {} sequences", record.sequences) : "", outcome_line(responses));
}

store::Table moments_table(const Responses& responses) {
    store::Table table;
    table.columns = {"observable", "unit", "mean", "sd", "skewness", "g1", "kurtosis", "values"};
    for (const auto* response : main_first(responses)) {
        const auto history = figures_of(responses, *response);
        const auto& all = history.provisional ? *history.provisional : history.all;
        std::vector<store::Table::Cell> row = {response->name, response->unit};
        for (const auto statistic : stats::statistics)
            row.emplace_back(with_error(all.of(statistic).value, all.of(statistic).error));
        row.emplace_back(all.count);
        table.rows.push_back(std::move(row));
    }
    return table;
}

store::Table extremes_table(const Responses& responses, const ResponseColumn& response, std::size_t count) {
    store::Table table;
    table.columns = {"", "point"};
    if (responses.campaign.replicates > 1) table.columns.emplace_back("replicate");
    for (const auto& factor : responses.factors) table.columns.push_back(with_unit(factor.name, factor.unit));
    table.columns.push_back(with_unit(response.name, response.unit));
    if (!responses.case_ids.empty()) table.columns.emplace_back("case_id");
    const auto values = responses.known(response);
    const auto finite =
        static_cast<std::size_t>(std::ranges::count_if(values, [](double x) { return std::isfinite(x); }));
    const std::size_t large = finite <= 2 * count ? finite : count;
    for (const auto row : extreme_rows(values, large, true)) {
        add_extreme(table, responses, response, row, table.rows.empty() ? "largest" : "");
    }
    if (large == finite) return table;
    auto smallest = extreme_rows(values, count, false);
    std::ranges::reverse(smallest);
    for (const auto row : smallest) {
        add_extreme(table, responses, response, row, row == smallest.back() ? "smallest" : "");
    }
    return table;
}

Document closing_summary(const store::Store& store, const std::string& campaign, const std::filesystem::path& database,
                         bool all) {
    const auto responses = read_responses(store, find_campaigns(store, campaign).front());
    Document shown;
    shown.say(fmt::format("{}: {} cases of {}: {}", campaign, responses.rows(), shown_scene(responses.campaign.scene),
                          outcome_line(responses)));
    if (const auto imported = store.imported_cases(campaign); imported > 0)
        shown.say(fmt::format("{} of the cases were computed elsewhere and imported", imported));
    if (!responses.campaign.condition.empty()) shown.say("where: " + points_line(responses));
    if (const auto brackets = brackets_of(store, responses.campaign)) {
        shown.say(brackets_line(*brackets)).say().show(brackets_table(*brackets));
    } else if (const auto calibration = calibration_report(store, responses.campaign)) {
        say_calibration(shown, *calibration);
    } else if (const auto* main = responses.main_observable()) {
        const bool has_rule = responses.campaign.convergence.has_value();
        const auto history = has_rule ? history_of(responses, *main) : figures_of(responses, *main);
        if (all && history.has_rule) shown.say(fmt::format("{}: {}", main->name, history.verdict));
        shown.say_notes(history.warnings);
        if (responses.finished() > 0) (all ? show_all_moments : show_main_moments)(shown, responses, history);
    }
    const auto file = shell_word(database.string());
    shown.say(fmt::format("\ndatabase {}\nnext: {}", named_with_size(database), next_command("report " + file)));
    if (responses.ordered_sample()) shown.say("      " + next_command("sensitivity " + file));
    shown.say("      " + next_command(fmt::format("query {} \"SELECT * FROM {}\"", file, campaign)));
    return shown;
}

}  // namespace grainsweep::report
