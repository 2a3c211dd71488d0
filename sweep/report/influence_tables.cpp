#include "sweep/report/influence_tables.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/report/model_tables.hpp"
#include "sweep/report/summary.hpp"
#include "sweep/study/error_text.hpp"

#include <fmt/format.h>
#include <array>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace grainsweep::report {

using namespace study;

std::string_view method_name(Influence::Method method) {
    switch (method) {
        case Influence::Method::given_data:
            return "given_data";
        case Influence::Method::saltelli:
            return "saltelli";
        case Influence::Method::morris:
            return "morris";
    }
    return "";
}

namespace {

using Cell = store::Table::Cell;

/// Returns the figure that orders the factors, the most informative one of the method.
double weight(const FactorInfluence& factor) {
    const double value = factor.effects                      ? factor.effects->mu_star
                         : std::isfinite(factor.total.value) ? factor.total.value
                                                             : factor.first.value;
    return std::isfinite(value) ? value : -1;
}

Cell trend_cell(const FactorInfluence& factor) {
    return factor.trend == Trend::unknown ? Cell{} : Cell{std::string(to_string(factor.trend))};
}

Result<results::estimate> index_json(const stats::SensitivityIndex& index) {
    return {{"value", index.value}, {"error", index.half_width}};
}

/// Calls with (j, k, index) of every pair.
template <class With>
void for_each_pair(const ModelInfluence& influence, With with) {
    std::size_t place = 0;
    for (std::size_t j = 0; j < influence.factors.size(); ++j)
        for (std::size_t k = j + 1; k < influence.factors.size(); ++k) with(j, k, influence.indices->pairs[place++]);
}

/// Returns the table for programs: one row per factor, or group of factors, in the campaign's order. Figures that the
/// method lacks are absent.
store::Table influence_rows(const Responses& responses, const ResponseColumn& response, const Influence& influence) {
    store::Table table{{"campaign", "observable", "method", "factor", "first", "first_error", "first_saltelli",
                        "first_saltelli_error", "total", "total_error", "mu", "mu_star", "mu_star_error", "sigma",
                        "used", "excluded", "trend", "rank_correlation", "rank_correlation_error"},
                       {}};
    for (const auto& factor : influence.factors) {
        std::vector<Cell> row = {responses.campaign.name, response.name, std::string(method_name(influence.method)),
                                 factor.factor};
        for (const auto& index : {factor.first, factor.first_saltelli, factor.total}) {
            row.push_back(to_cell(index.value));
            row.push_back(to_cell(index.half_width));
        }
        const auto effects = factor.effects.value_or(stats::ElementaryEffects{});
        for (const double x : {effects.mu, effects.mu_star, effects.mu_star_half_width, effects.sigma})
            row.push_back(to_cell(x));
        row.emplace_back(influence.used);
        row.emplace_back(influence.excluded);
        row.push_back(trend_cell(factor));
        row.push_back(to_cell(factor.rank_correlation.value));
        row.push_back(to_cell(factor.rank_correlation.half_width));
        table.rows.push_back(std::move(row));
    }
    return table;
}

}  // namespace

Json shown_of(Influence::Method method) {
    const auto column = [](const char* title, const char* text) { return Json{{"column", title}, {"text", text}}; };
    switch (method) {
        case Influence::Method::morris:
            return {{"says", "Change of the response over the range of each factor."},
                    {"shares", false},
                    {"shows", std::array{column("mu*", "mu_star_text"), column("sigma", "sigma")}}};
        case Influence::Method::saltelli:
            return {
                {"says", "Share of the variance of the response due to each factor alone, and with its interactions."},
                {"shares", true},
                {"shows", std::array{column("first order", "first_text"), column("total", "total_text")}}};
        case Influence::Method::given_data:
            break;
    }
    return {{"says", "Share of the variance of the response due to each factor alone."},
            {"shares", true},
            {"shows", std::array{column("first order", "first_text")}}};
}

store::Table influence_table(const Influence& influence) {
    std::vector<const FactorInfluence*> order;
    for (const auto& factor : influence.factors) order.push_back(&factor);
    std::ranges::stable_sort(order, std::ranges::greater{}, [](const auto* factor) { return weight(*factor); });
    store::Table table{{"factor"}, {}};
    const bool morris = influence.method == Influence::Method::morris;
    if (morris) {
        table.columns.insert(table.columns.end(), {"trend", "mu*", "mu", "sigma", "effects"});
    } else {
        table.columns.emplace_back("first order");
        if (influence.method == Influence::Method::saltelli) table.columns.emplace_back("total");
        table.columns.insert(table.columns.end(), {"trend", "rank correlation"});
    }
    for (const auto* factor : order) {
        std::vector<Cell> row = {factor->factor};
        if (morris) row.push_back(trend_cell(*factor));
        if (morris && factor->effects) {
            row.emplace_back(with_error(factor->effects->mu_star, factor->effects->mu_star_half_width));
            row.push_back(to_cell(factor->effects->mu));
            row.push_back(to_cell(factor->effects->sigma));
            row.emplace_back(factor->effects->count);
        } else if (!morris) {
            row.emplace_back(index_text(factor->first));
            if (influence.method == Influence::Method::saltelli) row.emplace_back(index_text(factor->total));
            row.push_back(trend_cell(*factor));
            row.emplace_back(with_error(factor->rank_correlation.value, factor->rank_correlation.half_width));
        }
        row.resize(table.columns.size());
        table.rows.push_back(std::move(row));
    }
    return table;
}

Result<results::sensitivity> to_json(const Responses& responses, const ResponseColumn& response,
                                     const Influence& influence) {
    const auto json_of_factor = [&](const FactorInfluence& factor) {
        Result<results::factor_influence> one = {{"name", factor.factor}};
        if (!factor.members.empty()) one.add("members", factor.members);
        if (influence.method != Influence::Method::morris)
            one.add("bins", factor.bins).add("first", index_json(factor.first));
        if (influence.method == Influence::Method::saltelli)
            one.add("first_saltelli", index_json(factor.first_saltelli)).add("total", index_json(factor.total));
        if (factor.effects)
            one.add("mu_star", Result<results::estimate>{{"value", factor.effects->mu_star},
                                                         {"error", factor.effects->mu_star_half_width}})
                .add("mu", factor.effects->mu)
                .add("sigma", factor.effects->sigma);
        one.add("trend", to_json(trend_cell(factor)));
        return one.add("rank_correlation", index_json(factor.rank_correlation));
    };
    const auto& split = influence.split;
    return {{"campaign", responses.campaign.name},
            {"observable", response.name},
            {"method", method_name(influence.method)},
            {"used", influence.used},
            {"excluded", influence.excluded},
            {"factors", Json::list(influence.factors, json_of_factor)},
            {"variance", Result<results::variance_split>{{"main_effects", index_json(split.main_effects)},
                                                         {"unexplained", index_json(split.unexplained)},
                                                         {"interactions", index_json(split.interactions)},
                                                         {"scatter", index_json(split.scatter)},
                                                         {"interactions_of_two", nullptr},
                                                         {"scatter_and_higher", nullptr},
                                                         {"pure_error", split.pure.variance},
                                                         {"pure_error_freedom", split.pure.freedom}}},
            {"notes", influence.notes}};
}

store::Table model_influence_table(const ModelInfluence& influence) {
    store::Table table{{"factor", "first order", "total", "interactions"}, {}};
    if (influence.depends()) table.columns = {"factor", "Shapley effect"};
    if (!influence.indices) return table;
    const auto& indices = *influence.indices;
    const auto& weights = influence.depends() ? indices.shapley : indices.total;
    std::vector<std::size_t> order(influence.factors.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t j) { return weights[j].value; });
    for (const auto j : order)
        if (influence.depends())
            table.rows.push_back({influence.factors[j], index_text(indices.shapley[j])});
        else
            table.rows.push_back({influence.factors[j], index_text(indices.first[j]), index_text(indices.total[j]),
                                  index_text(indices.interactions[j])});
    return table;
}

namespace {

/// Returns a line on the variance from noise factors, and on the control factor that reduces it most, if one does so
/// significantly.
std::string noise_line(const ModelInfluence& influence) {
    const auto& noise = *influence.indices->noise;
    const auto text = fmt::format("noise ({}) makes {} of the variance of the mean response",
                                  campaign::listed(influence.noise), index_text(noise.total));
    const auto best = std::ranges::find_if(noise.controls, [](const auto& one) { return one.significant(); });
    if (best == noise.controls.end()) return text + "; no control factor reduces it significantly";
    return fmt::format("{}; {} reduces it most: to {} {}", text, influence.factors[best->factor],
                       index_text(best->left),
                       influence.calmest[static_cast<std::size_t>(best - noise.controls.begin())]);
}

Json noise_json(const ModelInfluence& influence) {
    if (influence.noise.empty()) return {};
    const auto& noise = *influence.indices->noise;
    Json controls = Json::array();
    for (std::size_t k = 0; k < noise.controls.size(); ++k)
        controls.push_back(Result<results::noise_control>{{"name", influence.factors[noise.controls[k].factor]},
                                                          {"where", influence.calmest[k]},
                                                          {"significant", noise.controls[k].significant()}}
                               .add(index_json(noise.controls[k].left)));
    return Result<results::noise_share>{{"factors", influence.noise}, {"controls", controls}}.add(
        index_json(noise.total));
}

}  // namespace

std::vector<std::string> model_influence_lines(const ModelInfluence& influence) {
    if (!influence.indices) return {fmt::format("no indices from a response model: {}", influence.refused)};
    std::vector<std::pair<double, std::string>> pairs;
    for_each_pair(influence, [&](std::size_t j, std::size_t k, const stats::SensitivityIndex& index) {
        if (!influence.depends() && index.value > index.half_width)
            pairs.emplace_back(-index.value, fmt::format("{} with {} {}", influence.factors[j], influence.factors[k],
                                                         index_text(index)));
    });
    std::ranges::sort(pairs);
    std::vector<std::string> lines;
    std::string text;
    for (const auto& [size, pair] : pairs) text += (text.empty() ? "interactions of pairs: " : ", ") + pair;
    if (!text.empty()) lines.push_back(text);
    if (influence.depends())
        lines.push_back(
            fmt::format("{} are columns of one sample and depend on each other: Shapley effects share the "
                        "variance between them, and do not depend on the order of the columns",
                        campaign::listed(influence.dependent)));
    if (!influence.noise.empty()) lines.push_back(noise_line(influence));
    const auto& quality = std::get<stats::ResponseModel>(influence.model->model).quality();
    lines.push_back(fmt::format(
        "shares of the variance of the mean response, by a model of {} cases with a leave-one-out error of {:.3f} "
        "standard deviations; {:.1f} % of the variance of single runs is scatter",
        quality.rests_on, quality.leave_one_out_error, 100 * quality.noise_share));
    if (influence.without_value > 0)
        lines.push_back(
            fmt::format("{} of {} cases have no value: the shares by the model are of the whole box, extrapolated into "
                        "the settings that failed",
                        influence.without_value, influence.without_value + quality.cases));
    for (const auto& note : influence.model->notes) lines.push_back(note);
    return lines;
}

Result<results::model_influence> model_influence_json(const ModelInfluence& influence) {
    Json factors = Json::array(), pairs = Json::array(), scatter, unexplained, model;
    if (influence.indices) {
        const auto& indices = *influence.indices;
        for (std::size_t j = 0; j < influence.factors.size(); ++j) {
            Result<results::model_index> factor = {{"name", influence.factors[j]}};
            if (influence.depends())
                factor.add("shapley", index_json(indices.shapley[j]));
            else
                factor.add("first", index_json(indices.first[j]))
                    .add("total", index_json(indices.total[j]))
                    .add("interactions", index_json(indices.interactions[j]));
            factors.push_back(factor);
        }
        for_each_pair(influence, [&](std::size_t j, std::size_t k, const stats::SensitivityIndex& index) {
            if (influence.depends()) return;
            pairs.push_back(
                Result<results::pair_index>{{"factors", std::array{influence.factors[j], influence.factors[k]}}}.add(
                    index_json(index)));
        });
        const auto& quality = std::get<stats::ResponseModel>(influence.model->model).quality();
        scatter = quality.noise_share;
        unexplained = std::pow(quality.leave_one_out_error, 2);
        model = model_json(*influence.model);
    }
    return {{"factors", factors},
            {"pairs", pairs},
            {"scatter_share", scatter},
            {"unexplained_share", unexplained},
            {"response_model", model},
            {"noise", noise_json(influence)},
            {"refused", influence.indices ? Json() : Json(influence.refused)}};
}

Json model_influence_page(const ModelInfluence& influence) {
    return columns_and_rows(model_influence_table(influence)).add("says", model_influence_lines(influence));
}

Document influence_document(const Responses& responses, const ResponseColumn& response, Format format) {
    const auto influence = influence_of(responses, response);
    Document shown{.rows = influence_rows(responses, response, influence)};
    if (format == Format::csv) return shown;
    const auto modelled = model_influence_of(responses, response);
    shown.value = to_json(responses, response, influence).add("model", model_influence_json(modelled));
    shown.say(study_heading(responses, response)).say().show(influence_table(influence)).say();
    if (const auto text = unexplained_text(influence); !text.empty()) shown.say(text);
    shown.say_notes(influence.notes);
    if (modelled.indices) shown.say("\nby a response model:").show(model_influence_table(modelled)).say();
    for (const auto& line : model_influence_lines(modelled)) shown.say(line);
    return shown;
}

}  // namespace grainsweep::report
