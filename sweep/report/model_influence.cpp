#include "sweep/report/model_influence.hpp"

#include "sweep/report/box_search.hpp"
#include "sweep/report/model_tables.hpp"
#include "sweep/report/sample_parts.hpp"
#include "sweep/report/summary.hpp"
#include "sweep/report/table.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <utility>

namespace grainsweep::report {
namespace {

using Json = nlohmann::ordered_json;

bool varies(const ModelFactor& factor) {
    return factor.is_word() ? factor.words.size() > 1 : factor.high > factor.low;
}

/// The parts that errors come from, of the cases at `rows`; empty where they are fewer than two.
std::vector<std::size_t> groups_of(const Responses& responses, std::span<const std::size_t> rows) {
    const auto labels = sample_parts(responses).labels;
    std::vector<std::size_t> groups;
    for (const auto row : rows) groups.push_back(labels[row]);
    return std::set(groups.begin(), groups.end()).size() < 2 ? std::vector<std::size_t>{} : groups;
}

/// Features of points of the cube of the factors that vary; the others stay where they are.
stats::FeatureMap model_map(const ObservableModel& model, const std::vector<ModelFactor>& factors,
                            const std::vector<std::size_t>& varied) {
    return [&model, &factors, &varied](stats::Rows points) {
        std::vector<double> rows;
        std::vector<double> u(factors.size(), 0);
        for (std::size_t i = 0; i < points.size(); ++i) {
            for (std::size_t j = 0; j < varied.size(); ++j) u[varied[j]] = points.row(i)[j];
            const auto row = model.features.of(exact_setting(factors, u));
            rows.insert(rows.end(), row.begin(), row.end());
        }
        return rows;
    };
}

Json json_of(const stats::SensitivityIndex& index) {
    return {{"value", json_number(index.value)}, {"error", json_number(index.half_width)}};
}

/// Calls with (j, k, index) of every pair.
template <class With>
void for_each_pair(const ModelInfluence& influence, With with) {
    std::size_t place = 0;
    for (std::size_t j = 0; j < influence.factors.size(); ++j)
        for (std::size_t k = j + 1; k < influence.factors.size(); ++k) with(j, k, influence.indices->pairs[place++]);
}

}  // namespace

ModelInfluence model_influence_of(const Responses& responses, const ResponseColumn& response) {
    ModelInfluence found;
    if (responses.dropped() > 0) {
        found.refused = "the campaign's `where` leaves a part of the box out, and a model has no cases there";
        return found;
    }
    std::vector<std::size_t> rows;
    const auto cases = settled_cases(responses, &rows);
    std::vector<std::size_t> varied;
    for (std::size_t j = 0; j < cases.factors.size(); ++j)
        if (varies(cases.factors[j])) varied.push_back(j);
    for (const auto j : varied) found.factors.push_back(cases.factors[j].name);
    auto learned = learn(cases, cases.observable(response.name));
    if (auto* refused = std::get_if<stats::Refusal>(&learned)) {
        found.refused = std::move(refused->sentence);
        return found;
    }
    found.model = std::get<ObservableModel>(std::move(learned));
    found.without_value = responses.without_value(response);
    found.indices = stats::model_indices(found.model->model, varied.size(), groups_of(responses, rows),
                                         model_map(*found.model, cases.factors, varied));
    return found;
}

store::Table model_influence_table(const ModelInfluence& influence) {
    store::Table table{{"factor", "first order", "total", "interactions"}, {}};
    if (!influence.indices) return table;
    const auto& indices = *influence.indices;
    std::vector<std::size_t> order(influence.factors.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, std::ranges::greater{}, [&](std::size_t j) { return indices.total[j].value; });
    for (const auto j : order)
        table.rows.push_back({influence.factors[j], index_text(indices.first[j]), index_text(indices.total[j]),
                              index_text(indices.interactions[j])});
    return table;
}

std::vector<std::string> model_influence_lines(const ModelInfluence& influence) {
    if (!influence.indices) return {fmt::format("no indices from a response model: {}", influence.refused)};
    std::vector<std::pair<double, std::string>> pairs;
    for_each_pair(influence, [&](std::size_t j, std::size_t k, const stats::SensitivityIndex& index) {
        if (index.value > index.half_width)
            pairs.emplace_back(-index.value, fmt::format("{} with {} {}", influence.factors[j], influence.factors[k],
                                                         index_text(index)));
    });
    std::ranges::sort(pairs);
    std::vector<std::string> lines;
    std::string text;
    for (const auto& [size, pair] : pairs) text += (text.empty() ? "interactions of pairs: " : ", ") + pair;
    if (!text.empty()) lines.push_back(text);
    const auto& quality = influence.model->model.quality();
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

Json model_influence_json(const ModelInfluence& influence) {
    Json value = {{"factors", Json::array()},     {"pairs", Json::array()},    {"scatter_share", nullptr},
                  {"unexplained_share", nullptr}, {"response_model", nullptr}, {"refused", nullptr}};
    if (!influence.indices) {
        value["refused"] = influence.refused;
        return value;
    }
    const auto& indices = *influence.indices;
    for (std::size_t j = 0; j < influence.factors.size(); ++j)
        value["factors"].push_back({{"name", influence.factors[j]},
                                    {"first", json_of(indices.first[j])},
                                    {"total", json_of(indices.total[j])},
                                    {"interactions", json_of(indices.interactions[j])}});
    for_each_pair(influence, [&](std::size_t j, std::size_t k, const stats::SensitivityIndex& index) {
        Json pair = {{"factors", {influence.factors[j], influence.factors[k]}}};
        pair.update(json_of(index));
        value["pairs"].push_back(std::move(pair));
    });
    const auto& quality = influence.model->model.quality();
    value["scatter_share"] = json_number(quality.noise_share);
    value["unexplained_share"] = json_number(std::pow(quality.leave_one_out_error, 2));
    value["response_model"] = model_json(*influence.model);
    return value;
}

}  // namespace grainsweep::report
