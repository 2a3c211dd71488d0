// plan: check and unfold a campaign; show the design and the predicted cost; run nothing.
#include "sweep/campaign/forecast.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/campaign/wrong_question.hpp"
#include "sweep/cli/command.hpp"
#include "sweep/cli/progress.hpp"
#include "sweep/store/expression.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <iostream>
#include <memory>
#include <set>

namespace grainsweep::cli {

namespace {

using campaign::Campaign;
using campaign::PlacedCase;
using report::Format;
using Cell = store::Table::Cell;
using Json = nlohmann::ordered_json;

constexpr std::size_t points_shown = 8;

Json json_of(const designs::OptionValue& value) {
    if (const auto* rows = std::get_if<designs::Rows>(&value)) {
        Json list = Json::array();
        for (const auto& row : *rows) {
            Json cells = Json::array();
            for (const auto& cell : row) cells.push_back(report::to_json(report::to_cell(cell)));
            list.push_back(std::move(cells));
        }
        return list;
    }
    if (const auto* count = std::get_if<std::int64_t>(&value)) return *count;
    if (const auto* word = std::get_if<std::string>(&value)) return *word;
    return std::get<std::vector<std::int64_t>>(value);
}

std::string text_of(const designs::OptionValue& value) {
    if (const auto* rows = std::get_if<designs::Rows>(&value)) return fmt::format("({} of them)", rows->size());
    if (const auto* word = std::get_if<std::string>(&value)) return *word;
    return json_of(value).dump();
}

store::Table factors_of(const Campaign& campaign) {
    store::Table table{{"factor", "unit", "low", "high", "scale", "levels"}, {}};
    for (const auto& factor : campaign.space.factors) {
        const Cell unit = campaign.scene().find_parameter(factor.name)->unit;
        if (const auto* range = std::get_if<campaign::Between>(&factor.range)) {
            const std::string scale = range->scale == campaign::Scale::log ? "log" : "linear";
            table.rows.push_back({factor.name, unit, range->low, range->high, scale, Cell{}});
        } else {
            std::string levels;
            for (const auto& level : std::get<campaign::Levels>(factor.range).values) {
                levels += (levels.empty() ? "" : ", ") + campaign::to_text(level);
            }
            table.rows.push_back({factor.name, unit, Cell{}, Cell{}, Cell{}, levels});
        }
    }
    return table;
}

/// One row per placed case: where it stands, what it is, its factors.
store::Table cases_of(const Campaign& campaign, std::span<const PlacedCase> cases) {
    store::Table table{{"point", "sequence", "replicate", "case_id", "seed"}, {}};
    for (const auto& factor : campaign.space.factors) table.columns.push_back(factor.name);
    for (const auto& placed : cases) {
        auto& row = table.rows.emplace_back();
        row = {placed.point, placed.sequence, placed.replicate, placed.question.id,
               static_cast<std::int64_t>(placed.question.seed)};
        for (const auto& factor : campaign.space.factors) {
            row.push_back(report::to_cell(placed.question.inputs.at(factor.name)));
        }
    }
    return table;
}

std::int64_t points_kept(std::span<const PlacedCase> cases) {
    std::set<std::int64_t> points;
    for (const auto& placed : cases) points.insert(placed.point);
    return static_cast<std::int64_t>(points.size());
}

Json json_of(const Campaign& campaign, std::span<const PlacedCase> cases, const campaign::Forecast& cost) {
    Json object = {
        {"campaign", campaign.name}, {"scene", campaign.scene().name}, {"revision", campaign.scene().revision}};
    object["design"] = {{"kind", campaign.design}};
    for (const auto& [name, value] : campaign.request.options) object["design"][name] = json_of(value);
    object["seed"] = report::to_json(Cell{static_cast<std::int64_t>(campaign.seed)});
    object["replicates"] = campaign.replicates;
    object["points"] = points_kept(cases);
    object["cases"] = cost.places;
    object["questions"] = cost.questions;
    object["proven"] = cost.proven;
    object["impossible"] = cost.impossible;
    object["predicted_seconds"] = cost.total_seconds;
    object["longest_seconds"] = cost.longest_seconds;
    object["factors"] = report::to_json(factors_of(campaign));
    object["fixed"] = Json::object();
    for (const auto& [name, value] : campaign.space.fixed)
        object["fixed"][name] = report::to_json(report::to_cell(value));
    object["rows"] = report::to_json(cases_of(campaign, cases));
    return object;
}

std::string seconds_text(double seconds) {
    return seconds < 60 ? fmt::format("{:.2g} s", seconds) : duration(seconds);
}

void show_text(const Campaign& campaign, std::span<const PlacedCase> cases, const campaign::Forecast& cost) {
    const auto& scene = campaign.scene();
    std::cout << fmt::format("campaign   {}: {} (revision {})\n", campaign.name, scene.name, scene.revision);
    std::cout << fmt::format("design     {}", campaign.design);
    for (const auto& [name, value] : campaign.request.options) {
        if (const auto text = text_of(value); text != "[]") std::cout << fmt::format(", {} {}", name, text);
    }
    std::cout << fmt::format(", seed {}\n", campaign.seed);
    if (!campaign.where.empty()) std::cout << fmt::format("where      {}\n", campaign.where);
    std::cout << fmt::format("points     {}\nreplicates {}\ncases      {}", points_kept(cases), campaign.replicates,
                             cost.places);
    if (cost.questions != cost.places) std::cout << fmt::format(", {} different", cost.questions);
    if (cost.proven > 0) std::cout << fmt::format(", {} of them answered without simulation", cost.proven);
    if (cost.impossible > 0)
        std::cout << fmt::format("\nimpossible {} of them, which will be rejected; point {}: {}", cost.impossible,
                                 cost.first_point, cost.first_reason);
    std::cout << fmt::format("\npredicted  {} on one core; the longest case {}\n", seconds_text(cost.total_seconds),
                             seconds_text(cost.longest_seconds));
    if (const auto& convergence = campaign.convergence) {
        std::cout << fmt::format("judged by  {} on {} within {}, every {} points\n", convergence->rule,
                                 convergence->observable, convergence->tolerance, convergence->block);
    }
    for (const auto& [name, value] : campaign.space.fixed) {
        const auto& unit = scene.find_parameter(name)->unit;
        std::cout << fmt::format("fixed      {} = {}{}\n", name, campaign::to_text(value),
                                 unit.empty() || unit == "1" ? "" : " " + unit);
    }
    std::cout << '\n';
    report::write(std::cout, factors_of(campaign), Format::text);
    std::cout << '\n';
    const auto shown = cases.first(std::min(cases.size(), points_shown));
    report::write(std::cout, cases_of(campaign, shown), Format::text);
    if (shown.size() < cases.size()) {
        std::cout << fmt::format("... and {} more; --format csv or json shows all\n", cases.size() - shown.size());
    }
}

int plan(const std::string& config, Format format) {
    const Campaign campaign = campaign::read_campaign(config);
    const auto cases = campaign::asked_in(config, [&] {
        return campaign::unfold(campaign, store::make_filter(campaign.where, campaign::filter_names(campaign)));
    });
    const auto cost = campaign::asked_in(config, [&] { return campaign::forecast(campaign.scene(), cases); });
    if (format == Format::text) show_text(campaign, cases, cost);
    if (format == Format::csv) report::write(std::cout, cases_of(campaign, cases), format);
    if (format == Format::json) report::write(std::cout, json_of(campaign, cases, cost));
    return 0;
}

}  // namespace

std::vector<Command> plan_commands() {
    return {{"plan", "check and unfold a campaign; show the design and the predicted cost; run nothing",
             [](Parser& parser, const Format& format) -> Action {
                 const auto config = std::make_shared<std::string>();
                 parser.add_option("CONFIG", *config, "campaign file")->required();
                 return [config, &format] { return plan(*config, format); };
             },
             false}};
}

}  // namespace grainsweep::cli
