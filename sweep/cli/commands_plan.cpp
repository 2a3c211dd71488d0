// plan: check and unfold a campaign; show the design and the predicted cost; run nothing.
#include "sweep/campaign/experiments.hpp"
#include "sweep/campaign/expressions.hpp"
#include "sweep/campaign/forecast.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/machine.hpp"
#include "sweep/campaign/machine_shape_file.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/campaign/stated_distribution.hpp"
#include "sweep/campaign/stored_text.hpp"
#include "sweep/cli/adopt.hpp"
#include "sweep/cli/command.hpp"
#include "sweep/cli/program_campaign.hpp"
#include "sweep/cli/progress.hpp"
#include "sweep/report/result.hpp"
#include "sweep/report/results/runs.hpp"
#include "sweep/store/campaign_name.hpp"
#include "sweep/store/expression.hpp"
#include "sweep/store/store.hpp"
#include "sweep/study/features.hpp"
#include "sweep/study/history.hpp"
#include "sweep/workers/compute.hpp"
#include "sweep/workers/memory_room.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace grainsweep::cli {
namespace {

using campaign::Campaign;
using campaign::Cases;
using report::Format;
using report::Json;
using report::Result;
namespace results = report::results;
using Cell = store::Table::Cell;

/// Bars of the probability in equal parts of the range, the highest full.
std::string density_text(const stats::Distribution& distribution) {
    constexpr std::array<std::string_view, 9> bars = {" ", "▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
    constexpr std::size_t parts = 16;
    const auto [low, high] = distribution.range();
    std::array<double, parts> shares{};
    double before = distribution.cumulative(low), highest = 0;
    for (std::size_t k = 0; k < parts; ++k) {
        const double upto = k + 1 == parts
                                ? distribution.cumulative(high)
                                : distribution.cumulative(std::lerp(low, high, static_cast<double>(k + 1) / parts));
        shares[k] = upto - before;
        before = upto;
        highest = std::max(highest, shares[k]);
    }
    std::string text;
    for (const double share : shares)
        text += bars[share > 0 ? static_cast<std::size_t>(std::ceil(8 * share / highest)) : 0];
    return "|" + text + "|";
}

/// "multiples of 0.5, when tool = 'roller'"; of a program also what it gets otherwise: ", else 0".
std::string factor_rules(const campaign::Factor& factor, const SceneInfo& scene) {
    std::vector<std::string> rules;
    if (factor.step) rules.push_back(fmt::format("multiples of {}", campaign::shortest(*factor.step)));
    if (factor.share) rules.emplace_back("share");
    if (!factor.group.empty()) rules.push_back("group " + factor.group);
    if (!factor.when.empty()) rules.push_back("when " + factor.when);
    if (!factor.when.empty() && campaign::is_program(scene.name)) {
        const auto standard = campaign::to_text(campaign::default_of(scene, factor.name));
        rules.back() += ", else " + (standard.empty() ? "''" : standard);
    }
    return fmt::format("{}", fmt::join(rules, ", "));
}

/// Adds a column for the rules of factors besides their values, if a factor has one.
void add_rules(store::Table& table, const std::vector<campaign::Factor>& factors, const SceneInfo& scene) {
    if (std::ranges::all_of(factors, [&](const auto& factor) { return factor_rules(factor, scene).empty(); })) return;
    table.columns.emplace_back("rules");
    for (std::size_t j = 0; j < factors.size(); ++j) table.rows[j].emplace_back(factor_rules(factors[j], scene));
}

/// "12.57 rad/s" of a value in rpm, with which the expressions of a machine calculate; empty elsewhere.
std::string in_expressions(const Campaign& campaign, const std::string& unit, const Value& value) {
    const auto* number = std::get_if<double>(&value);
    if (number == nullptr || !campaign::is_machine(campaign.scene().name)) return {};
    return campaign::value_in_expressions(unit, *number);
}

store::Table factors_of(const Campaign& campaign) {
    store::Table table{report::columns_of(results::planned_factor), {}};
    table.columns.pop_back();  // the rules
    for (const auto& factor : campaign.space.factors) {
        const auto& stated = campaign.scene().find_parameter(factor.name)->unit;
        const auto calculated = in_expressions(campaign, stated, 1.0);
        const Cell unit = calculated.empty() ? stated : fmt::format("{} (1 {} is {})", stated, stated, calculated);
        if (const auto* range = std::get_if<campaign::Between>(&factor.range)) {
            const std::string scale = range->scale == campaign::Scale::log ? "log" : "linear";
            table.rows.push_back({factor.name, unit, range->low, range->high, scale, Cell{}});
        } else if (const auto* distribution = std::get_if<stats::Distribution>(&factor.range)) {
            const auto [low, high] = distribution->range();
            table.rows.push_back({factor.name, unit, low, high, campaign::described(*distribution), Cell{}});
        } else {
            std::string levels;
            for (const auto& level : std::get<campaign::Levels>(factor.range).values) {
                levels += (levels.empty() ? "" : ", ") + campaign::to_text(level);
            }
            table.rows.push_back({factor.name, unit, Cell{}, Cell{}, Cell{}, levels});
        }
    }
    add_rules(table, campaign.space.factors, campaign.scene());
    return table;
}

/// Returns one row for each factor with a distribution: quantiles, the density as a row of characters along the range,
/// and the share outside the bounds of the parameter.
store::Table distributions_of(const Campaign& campaign) {
    store::Table table{report::columns_of(results::planned_distribution), {}};
    for (const auto& factor : campaign.space.factors) {
        const auto* distribution = std::get_if<stats::Distribution>(&factor.range);
        if (distribution == nullptr) continue;
        std::vector<Cell> row = {factor.name, 100 * distribution->cut()};
        for (const double u : {0.05, 0.5, 0.95}) row.emplace_back(distribution->quantile(u));
        row.emplace_back(density_text(*distribution));
        table.rows.push_back(std::move(row));
    }
    return table;
}

/// Returns one row for each species with a shape in the first possible case of a machine: its spheres, how well they
/// cover an STL file, and what they cost.
store::Table grains_of(const Campaign& campaign, const Cases& cases, const campaign::Forecast& cost) {
    store::Table table{report::columns_of(results::planned_grain), {}};
    const auto machine = campaign::known_machine(campaign.scene().name);
    const auto first = std::ranges::find_if(cost.seconds, [](double seconds) { return seconds > 0; });
    if (machine == nullptr || first == cost.seconds.end()) return table;
    const auto inputs = cases.question(static_cast<std::size_t>(first - cost.seconds.begin())).inputs;
    for (const auto& grain : campaign::grains_of(*machine, inputs))
        table.rows.push_back({grain.species, static_cast<std::int64_t>(grain.spheres),
                              grain.cover ? Cell(*grain.cover) : Cell(), grain.smallest, grain.cost});
    return table;
}

/// One case of the campaign, computed to measure the time of the others.
struct Probe {
    std::int64_t point = 0;
    campaign::CaseId case_id;
    campaign::Outcome outcome{};
    std::string message;
    double predicted = 0;  ///< seconds
    double measured = 0;   ///< seconds: processor time of a scene, time of a program
};

campaign::CaseResult probed_answer(const campaign::Case& question, std::optional<double> limit_seconds) {
    if (auto program = campaign::known_program(question.scene))
        return answer_by_program(std::move(program), question, 1, limit_seconds, {}, {});
    NoArtefacts artefacts;
    return workers::compute(question, 1, artefacts, std::nullopt, [](const Scene&) { return true; }).value();
}

/// Computes, in this process, the case of median predicted cost among the cases that are not settled, proven or
/// impossible. Empty if there is no such case. The answer is not stored.
std::optional<Probe> probe_median_case(const Campaign& campaign, const Cases& cases, const campaign::Forecast& forecast,
                                       const std::vector<bool>& settled) {
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < cases.size(); ++i)
        if (!settled[i] && cases.is_first(i) && forecast.seconds[i] > 0) open.push_back(i);
    if (open.empty()) return std::nullopt;
    const auto median = open.begin() + static_cast<std::ptrdiff_t>(open.size() / 2);
    std::ranges::nth_element(open, median, {}, [&](std::size_t i) { return std::pair(forecast.seconds[i], i); });
    const auto question = cases.question(*median);
    const auto result = probed_answer(question, campaign.limits.wall_seconds);
    return Probe{cases.place(*median).point,
                 question.id,
                 result.outcome,
                 result.message,
                 forecast.seconds[*median],
                 result.program ? result.cost.wall_seconds : result.cost.cpu_seconds};
}

/// Multiplies all predicted seconds by the ratio of measured to predicted seconds of the probe.
void scale_by(const Probe& probe, campaign::Forecast& forecast) {
    const double factor = probe.measured / probe.predicted;
    forecast.total_seconds *= factor;
    forecast.longest_seconds *= factor;
    for (double& seconds : forecast.seconds) seconds *= factor;
}

/// Returns a text such as "0.25 s" or "1 min 15 s".
std::string seconds_text(double seconds) {
    return seconds < 60 ? fmt::format("{:.2g} s", seconds) : duration(seconds);
}

std::string probe_text(const Probe& probe) {
    auto text =
        fmt::format("point {} took {}, {} were predicted; the times above are scaled by {:.2g}", probe.point,
                    seconds_text(probe.measured), seconds_text(probe.predicted), probe.measured / probe.predicted);
    if (probe.outcome != campaign::Outcome::completed)
        text += fmt::format(". It ended as {}{}{}", campaign::to_string(probe.outcome),
                            probe.message.empty() ? "" : ": ", probe.message);
    return text;
}

Json probe_json(const Probe& probe) {
    return Result<results::probed_case>{{"point", probe.point},
                                        {"case_id", probe.case_id},
                                        {"outcome", campaign::to_string(probe.outcome)},
                                        {"message", probe.message},
                                        {"predicted_seconds", probe.predicted},
                                        {"measured_seconds", probe.measured}};
}

constexpr std::size_t points_shown = 8;

Json option_json(const designs::OptionValue& value) {
    if (const auto* rows = std::get_if<designs::Rows>(&value))
        return Json::list(*rows, [](const auto& row) {
            return Json::list(row, [](const Value& cell) { return report::to_json(report::to_cell(cell)); });
        });
    if (const auto* count = std::get_if<std::int64_t>(&value)) return *count;
    if (const auto* word = std::get_if<std::string>(&value)) return *word;
    if (const auto* number = std::get_if<double>(&value)) return *number;
    return std::get<std::vector<std::int64_t>>(value);
}

std::string option_text(const designs::OptionValue& value) {
    if (const auto* rows = std::get_if<designs::Rows>(&value)) return fmt::format("({} of them)", rows->size());
    if (const auto* word = std::get_if<std::string>(&value)) return *word;
    return option_json(value).text();
}

/// Returns the columns of the table of cases: place in the design, case, factors.
std::vector<std::string> case_columns(const Campaign& campaign) {
    std::vector<std::string> columns = {"point", "sequence", "replicate", "case_id", "seed"};
    for (const auto& factor : campaign.space.factors) columns.push_back(factor.name);
    return columns;
}

/// The first rows, one after the other, none kept.
template <class Add>
void for_each_row(const Campaign& campaign, const Cases& cases, std::size_t rows, Add&& add) {
    campaign::Case question;
    std::vector<Cell> row;
    for (std::size_t i = 0; i < std::min(rows, cases.size()); ++i) {
        cases.question(i, question);
        const auto& [point, sequence, replicate] = cases.place(i);
        row = {std::int64_t{point}, std::int64_t{sequence}, std::int64_t{replicate}, question.id,
               static_cast<std::int64_t>(question.seed)};
        for (const auto& factor : campaign.space.factors)
            row.push_back(report::to_cell(question.inputs.at(factor.name)));
        add(row);
    }
}

std::int64_t points_kept(const Cases& cases) {
    std::int64_t points = 0;
    for (std::size_t i = 0; i < cases.size(); ++i) {
        if (i == 0 || cases.place(i).point != cases.place(i - 1).point) ++points;
    }
    return points;
}

constexpr double memory_worth_a_line = 1e9;  // bytes

/// Parts of a plan besides the campaign itself.
struct Outlook {
    Cases cases;
    campaign::Forecast cost;
    std::int64_t candidates = 0;
    std::vector<std::string> warnings;
    std::string database;                         ///< that has the campaign already; empty: none
    std::optional<store::CampaignRecord> stored;  ///< stored campaign, with the present request
    std::int64_t finished = 0;                    ///< of the cases, in the database
    double left_seconds = 0;                      ///< of one plain core, for the others
    std::optional<Probe> probe;                   ///< measured; the predictions are scaled by it
};

/// Unfolds the design and, with an `archive`, finds its stored cases. Factors get their stored order, as in a run.
Outlook outlook_of(Campaign& campaign, const store::Store* archive, bool probes) {
    store::check_campaign_name(campaign.name);
    study::check_features(campaign);
    if (archive != nullptr) campaign::reorder_factors(campaign, archive->factor_order(campaign.name));
    Outlook outlook;
    outlook.cases = campaign::unfold(campaign, store::make_filter(campaign.where, campaign::filter_names(campaign)));
    outlook.cost = campaign::forecast(campaign.scene(), outlook.cases, workers::memory_room(campaign));
    outlook.candidates = campaign::candidates_of(campaign);
    outlook.warnings = campaign::warnings_of(campaign, outlook.cost);
    if (archive != nullptr) outlook.finished = archive->settled(outlook.cases);
    std::vector<bool> settled(outlook.cases.size());
    for (std::size_t i = 0; outlook.finished > 0 && i < settled.size(); ++i)
        settled[i] = outlook.cases.is_first(i) && archive->is_settled(outlook.cases.id(i));
    if (probes) outlook.probe = probe_median_case(campaign, outlook.cases, outlook.cost, settled);
    if (outlook.probe) scale_by(*outlook.probe, outlook.cost);
    for (std::size_t i = 0; i < settled.size(); ++i)
        if (!settled[i] && outlook.cases.is_first(i)) outlook.left_seconds += outlook.cost.seconds[i];
    if (archive == nullptr) return outlook;
    outlook.stored = archive->stored(campaign);
    if (outlook.stored) outlook.stored->asked = {outlook.candidates, campaign.replicates};
    return outlook;
}

Json plan_json(const Campaign& campaign, const Outlook& outlook) {
    const auto& [cases, cost, candidates, warnings, database, stored, finished, left_seconds, probe] = outlook;
    Json design = Result<results::planned_design>{{"kind", campaign.design}}, already;
    for (const auto& [name, value] : campaign.request.options) design.add(name, option_json(value));
    if (stored)
        already = Result<results::stored_extent>{{"database", database},
                                                 {"candidates", stored->stored.candidates},
                                                 {"replicates", stored->stored.replicates}};
    const auto threads = campaign.execution.threads;
    const auto points = points_kept(cases);
    const auto course = campaign::longest_course(campaign, cost);
    Result<results::plan> plan = {{"campaign", campaign.name},
                                  {"scene", campaign.scene().name},
                                  {"revision", campaign.scene().revision},
                                  {"design", design},
                                  {"seed", report::to_json(Cell{static_cast<std::int64_t>(campaign.seed)})},
                                  {"replicates", campaign.replicates},
                                  {"candidates", candidates},
                                  {"dropped", candidates - points},
                                  {"points", points},
                                  {"cases", cost.places},
                                  {"finished", finished},
                                  {"stored", already},
                                  {"warnings", warnings},
                                  {"questions", cost.questions},
                                  {"proven", cost.proven},
                                  {"impossible", cost.impossible},
                                  {"predicted_seconds", cost.total_seconds},
                                  {"longest_seconds", cost.longest_seconds},
                                  {"left_seconds", left_seconds},
                                  {"probe", probe ? probe_json(*probe) : Json()},
                                  {"all_waves_seconds", course ? Json(course->seconds) : Json()},
                                  {"largest_bytes", cost.largest_bytes},
                                  {"threads", campaign::is_program(campaign.scene().name) ? Json()
                                              : threads                                   ? Json(*threads)
                                                                                          : Json("auto")},
                                  {"powder", campaign.powder.empty() ? Json() : Json(campaign.powder)},
                                  {"factors", report::to_json(factors_of(campaign))},
                                  {"fixed", report::to_json(campaign::fixed_as_stated(campaign.space))}};
    if (const auto distributions = distributions_of(campaign); !distributions.rows.empty())
        plan.add("distributions", report::to_json(distributions));
    if (const auto grains = grains_of(campaign, cases, cost); !grains.rows.empty())
        plan.add("grains", report::to_json(grains));
    return plan;
}

/// The object, with all rows of the design at its end.
void write_json(const Campaign& campaign, const Outlook& outlook) {
    std::string text = report::harmless_json(plan_json(campaign, outlook));
    text.pop_back();  // the closing brace
    std::cout << text << ",\"rows\":";
    report::RowWriter rows(std::cout, Format::json);
    rows.begin(case_columns(campaign));
    for_each_row(campaign, outlook.cases, outlook.cases.size(), [&](const auto& row) { rows.add(row); });
    rows.end(true);
    std::cout << "}\n";
}

void write_csv(const Campaign& campaign, const Outlook& outlook) {
    for (const auto& warning : outlook.warnings) std::cerr << "warning: " << warning << '\n';
    report::RowWriter rows(std::cout, Format::csv);
    rows.begin(case_columns(campaign));
    for_each_row(campaign, outlook.cases, outlook.cases.size(), [&](const auto& row) { rows.add(row); });
    rows.end();
}

/// Of a case; empty for a program, which has cores.
std::string threads_text(const Campaign& campaign) {
    if (campaign::is_program(campaign.scene().name)) return {};
    if (!campaign.execution.threads) return "one per case; more when fewer cases are left than cores";
    return fmt::format("{} per case", *campaign.execution.threads);
}

void show_plan(const Campaign& campaign, const Outlook& outlook) {
    const auto& cost = outlook.cost;
    const Cases& cases = outlook.cases;
    const auto& scene = campaign.scene();
    std::cout << fmt::format("campaign   {}: {} (revision {})\n", campaign.name, scene.shown(), scene.revision);
    std::cout << fmt::format("design     {}", campaign.design);
    for (const auto& [name, value] : campaign.request.options) {
        if (const auto text = option_text(value); text != "[]") std::cout << fmt::format(", {} {}", name, text);
    }
    std::cout << fmt::format(", seed {}\n", campaign.seed);
    if (!campaign.where.empty()) std::cout << fmt::format("where      {}\n", campaign.where);
    const std::int64_t points = points_kept(cases);
    std::cout << fmt::format("points     {}", points);
    if (points < outlook.candidates)
        std::cout << fmt::format(" of {} candidates, {} left out by where", outlook.candidates,
                                 outlook.candidates - points);
    std::cout << fmt::format("\nreplicates {}\ncases      {}", campaign.replicates, cost.places);
    if (cost.questions != cost.places) std::cout << fmt::format(", {} different", cost.questions);
    if (cost.proven > 0) std::cout << fmt::format(", {} of them answered without simulation", cost.proven);
    if (cost.impossible > 0)
        std::cout << fmt::format("\nimpossible {} of them will be rejected; first at point {}: {}", cost.impossible,
                                 cost.first_point, cost.first_reason);
    const auto course = campaign::longest_course(campaign, cost);
    std::cout << fmt::format("\npredicted  {} on one core{}; the longest case {}\n", seconds_text(cost.total_seconds),
                             course ? " for the first wave" : "", seconds_text(cost.longest_seconds));
    if (course)
        std::cout << fmt::format("all waves  {} on one core at most: {} waves of {} settings, {} checks\n",
                                 seconds_text(course->seconds), course->waves, course->points_per_wave, course->checks);
    if (outlook.probe) std::cout << fmt::format("probe      {}\n", probe_text(*outlook.probe));
    if (cost.largest_bytes >= memory_worth_a_line)
        std::cout << fmt::format("memory     {:.2g} GB for the largest case; {:.2g} GB are available\n",
                                 1e-9 * cost.largest_bytes, 1e-9 * workers::memory_room());
    if (const auto threads = threads_text(campaign); !threads.empty())
        std::cout << fmt::format("threads    {}\n", threads);
    if (!outlook.database.empty())
        std::cout << fmt::format("finished   {} of {} in {}{}\n", outlook.finished, cost.places, outlook.database,
                                 outlook.left_seconds > 0 ? fmt::format("; the others take {} on one core",
                                                                        seconds_text(outlook.left_seconds))
                                                          : "");
    if (outlook.stored) {
        if (const auto note = study::extent_note(*outlook.stored); !note.empty())
            std::cout << fmt::format("stored     {}\n", note);
    }
    for (const auto& warning : outlook.warnings) std::cout << fmt::format("warning    {}\n", warning);
    if (const auto& convergence = campaign.convergence) {
        std::cout << fmt::format("rule       {} on {}, tolerance {}, checked every {} points\n", convergence->rule,
                                 convergence->observable, convergence->tolerance, convergence->block);
    }
    if (const auto goal = campaign::remarks_in(campaign.text).goal)
        std::cout << fmt::format(
            "goal       {} of {} within {:.3g} % of {}; at most the cases above at {}, and pairs\n",
            campaign::listed(goal->gates), goal->observable, 100 * goal->tolerance, campaign::AccuracyGoal::measure,
            goal->setting.value_or("the setting that a pilot chooses"));
    if (!campaign.powder.empty()) std::cout << fmt::format("powder     {}\n", campaign.powder);
    for (const auto& [name, value] : campaign::fixed_as_stated(campaign.space)) {
        const auto& unit = scene.find_parameter(name)->unit;
        const bool bare = unit.empty() || unit == "1" || !campaign.space.fixed.contains(name);
        const auto calculated = bare ? std::string() : in_expressions(campaign, unit, value);
        std::cout << fmt::format("fixed      {} = {}{}{}\n", name, campaign::to_text(value), bare ? "" : " " + unit,
                                 calculated.empty() ? "" : fmt::format(" ({} in expressions)", calculated));
    }
    std::cout << '\n';
    report::write(std::cout, factors_of(campaign), Format::text);
    std::cout << '\n';
    if (const auto distributions = distributions_of(campaign); !distributions.rows.empty()) {
        report::write(std::cout, distributions, Format::text);
        std::cout << '\n';
    }
    if (const auto grains = grains_of(campaign, cases, cost); !grains.rows.empty()) {
        report::write(std::cout, grains, Format::text);
        std::cout << "in the first case; smallest sphere in diameters of the grain, cost in that of a sphere\n\n";
    }
    store::Table shown{case_columns(campaign), {}};
    for_each_row(campaign, cases, points_shown, [&](const auto& row) { shown.rows.push_back(row); });
    report::write(std::cout, shown, Format::text);
    if (shown.rows.size() < cases.size()) {
        std::cout << fmt::format("... and {} more; --format csv or json shows all\n", cases.size() - shown.rows.size());
    }
}

struct PlanRequest {
    std::string config, database;
    bool probe = false;
};

struct Planned {
    Campaign campaign;
    Outlook outlook;
};

Planned planned(const PlanRequest& request, std::string_view experiment) {
    const auto& config = request.config;
    auto database = request.database;
    Campaign campaign = read_with_program(config, experiment);
    const auto file = campaign::name_in_file(campaign::identity_of(campaign)) + ".db";
    std::optional<store::Store> archive;
    if (!database.empty())
        archive.emplace(database, store::Store::Mode::read);
    else if ((archive = store::Store::read_if_begun(file)))
        database = file;
    if (archive) campaign::asked_in(config, [&] { return refuse_another_program(*archive, campaign, database), 0; });
    auto outlook =
        campaign::asked_in(config, [&] { return outlook_of(campaign, archive ? &*archive : nullptr, request.probe); });
    outlook.database = database;
    return {std::move(campaign), std::move(outlook)};
}

void show_planned(const Planned& one, Format format) {
    if (format == Format::text) show_plan(one.campaign, one.outlook);
    if (format == Format::json) write_json(one.campaign, one.outlook);
    if (format == Format::csv) write_csv(one.campaign, one.outlook);
}

int plan(const PlanRequest& request, Format format) {
    const auto experiments = campaign::read_experiment_names(request.config);
    if (experiments.empty()) return show_planned(planned(request, ""), format), 0;
    if (format == Format::csv)
        throw campaign::input_error("--format", "csv",
                                    "the experiments have different columns; text and json show all");
    std::vector<Planned> all;  // every one is checked before the first is printed
    for (const auto& experiment : experiments) all.push_back(planned(request, experiment));
    double seconds = 0;
    for (std::size_t k = 0; k < all.size(); ++k) {
        if (format == Format::json) std::cout << (k == 0 ? "[" : ",");
        if (format == Format::text && k > 0) std::cout << '\n';
        show_planned(all[k], format);
        const auto course = campaign::longest_course(all[k].campaign, all[k].outlook.cost);
        seconds += course ? course->seconds : 0;
    }
    std::cout << (format == Format::json
                      ? "]\n"
                      : fmt::format("\nall waves of all experiments: {} on one core at most\n", seconds_text(seconds)));
    return 0;
}

}  // namespace

std::vector<Command> plan_commands() {
    const auto arguments = [](Parser& parser, PlanRequest& request) {
        parser.add_option("CONFIG", request.config, "campaign file");
        parser.add_option("--db FILE", request.database,
                          "database of the campaign, whose finished cases are counted; default: NAME.db in the current "
                          "folder, if it exists");
        parser.add_flag("--probe", request.probe,
                        "runs the case of median predicted cost and scales the prediction by what it took");
    };
    return {command<PlanRequest>("plan", "checks a campaign file; shows the design and the predicted cost", arguments,
                                 plan)};
}

}  // namespace grainsweep::cli
