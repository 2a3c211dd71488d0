#include "sweep/cli/plan_tables.hpp"

#include "sweep/campaign/stated_distribution.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace grainsweep::cli {
namespace {

using campaign::Campaign;
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

/// "multiples of 0.5, when tool = 'roller'".
std::string factor_rules(const campaign::Factor& factor) {
    std::vector<std::string> rules;
    if (factor.step) rules.push_back(fmt::format("multiples of {}", campaign::shortest(*factor.step)));
    if (factor.share) rules.emplace_back("share");
    if (!factor.group.empty()) rules.push_back("group " + factor.group);
    if (!factor.when.empty()) rules.push_back("when " + factor.when);
    return fmt::format("{}", fmt::join(rules, ", "));
}

/// Adds a column for the rules of factors besides their values, if a factor has one.
void add_rules(store::Table& table, const std::vector<campaign::Factor>& factors) {
    if (std::ranges::all_of(factors, [](const auto& factor) { return factor_rules(factor).empty(); })) return;
    table.columns.emplace_back("rules");
    for (std::size_t j = 0; j < factors.size(); ++j) table.rows[j].emplace_back(factor_rules(factors[j]));
}

}  // namespace

store::Table factors_of(const Campaign& campaign) {
    store::Table table{{"factor", "unit", "low", "high", "scale", "levels"}, {}};
    for (const auto& factor : campaign.space.factors) {
        const Cell unit = campaign.scene().find_parameter(factor.name)->unit;
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
    add_rules(table, campaign.space.factors);
    return table;
}

store::Table distributions_of(const Campaign& campaign) {
    store::Table table{{"factor", "cut %", "5 %", "50 %", "95 %", "low to high"}, {}};
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

}  // namespace grainsweep::cli
