#include "sweep/report/summary.hpp"

#include "sweep/report/file_size.hpp"
#include "sweep/report/findings.hpp"
#include "sweep/study/error_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace grainsweep::report {

using namespace study;

namespace {

constexpr std::size_t extremes_in_text = 3;

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

std::string moments_heading(const Responses& responses, const History& history) {
    if (!history.provisional) return fmt::format("moments over {} points, 95 % errors", responses.counted_points());
    return fmt::format(
        "provisional moments over all {} finished cases, 95 % errors; the settled beginning has {} points, and only "
        "that is judged",
        responses.finished(), responses.counted_points());
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

Document closing_summary(const store::Store& store, const std::string& campaign,
                         const std::filesystem::path& database) {
    const auto responses = read_responses(store, find_campaigns(store, campaign).front());
    Document shown;
    shown.say(fmt::format("{}: {} cases of {}: {}", campaign, responses.rows(), shown_scene(responses.campaign.scene),
                          outcome_line(responses)));
    if (!responses.campaign.condition.empty()) shown.say("where: " + points_line(responses));
    if (const auto brackets = brackets_of(store, responses.campaign)) {
        shown.say(brackets_line(*brackets)).say().show(brackets_table(*brackets));
    } else if (const auto calibration = calibration_report(store, responses.campaign)) {
        say_calibration(shown, *calibration);
    } else if (const auto* main = responses.main_observable()) {
        const bool has_rule = responses.campaign.convergence.has_value();
        const auto history = has_rule ? history_of(responses, *main) : figures_of(responses, *main);
        if (history.has_rule) shown.say(fmt::format("{}: {}", main->name, history.verdict));
        shown.say_notes(history.warnings);
        if (responses.finished() > 0)
            shown.say()
                .say(moments_heading(responses, history))
                .show(moments_table(responses))
                .say()
                .show(extremes_table(responses, *main, extremes_in_text));
    }
    shown.say(
        fmt::format("\ndatabase {2}\nnext: grainsweep report {0}\n      grainsweep query {0} \"SELECT * FROM {1}\"",
                    database.string(), campaign, named_with_size(database)));
    return shown;
}

}  // namespace grainsweep::report
