#include "sweep/report/estimators.hpp"

#include "sweep/campaign/wrong_question.hpp"
#include "sweep/designs/design.hpp"
#include "sweep/report/box_search.hpp"
#include "sweep/report/effects.hpp"
#include "sweep/report/response_models.hpp"
#include "sweep/report/sample_parts.hpp"
#include "sweep/report/summary.hpp"
#include "sweep/report/table.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace grainsweep::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t scramblings = 4, points_each = 8192, least_points_each = 256;
constexpr std::uint64_t seed_of_integration = 0x696e746567726174;  // of no campaign: its points are not among the cases
constexpr std::int64_t least_repeated = 100;

/// Points of the box, one scrambling after the other, all of one size; none where `where` leaves too small a part.
std::vector<Setting> integration_points(const ModelCases& cases, const Admits& admits) {
    const auto& design = designs::design_named("sobol");
    designs::DesignRequest request{.levels = std::vector<std::size_t>(cases.factors.size(), 0),
                                   .options = {{"scramble", std::string("random")},
                                               {"sequences", static_cast<std::int64_t>(scramblings)},
                                               {"points", static_cast<std::int64_t>(scramblings * points_each)}},
                                   .seed = seed_of_integration};
    for (const auto& option : design.options)
        if (option.default_value) request.options.try_emplace(option.name, *option.default_value);
    const auto set = design.sample(request);
    std::vector<std::vector<Setting>> parts(scramblings);
    for (std::size_t p = 0; p < set.size(); ++p) {
        auto setting = exact_setting(cases.factors, set.point(p));
        if (!admits || admits(setting)) parts[p % scramblings].push_back(std::move(setting));
    }
    const auto size = std::ranges::min(parts, {}, &std::vector<Setting>::size).size();
    std::vector<Setting> points;
    if (size < least_points_each) return points;
    for (auto& part : parts)
        points.insert(points.end(), part.begin(), part.begin() + static_cast<std::ptrdiff_t>(size));
    return points;
}

/// Variance of single runs: one per case, one for all, or none.
struct Noise {
    std::vector<double> variance;
    double relative_error = 0;
    std::string from;
};

Noise noise_of(const Responses& responses, const ResponseColumn& response, std::span<const std::size_t> rows) {
    const auto pure = effect_errors(responses, response).pure;
    if (pure.freedom >= least_repeated)
        return {{pure.variance}, std::sqrt(2 / static_cast<double>(pure.freedom)), "replicates"};
    const auto stated =
        std::ranges::find(responses.observables, response.name + "_standard_error", &ResponseColumn::name);
    if (stated == responses.observables.end()) return {};
    Noise noise{{}, 0, stated->name};
    for (const auto row : rows) {
        const double error = stated->values[row];
        noise.variance.push_back(std::isfinite(error) ? error * error : 0);
    }
    const bool any = std::ranges::any_of(noise.variance, [](double v) { return v > 0; });
    return any ? noise : Noise{};
}

Json json_of(double value, double error) {
    return {{"value", json_number(value)}, {"error", json_number(error)}};
}

/// An estimate with a model, marked where it is withdrawn.
std::string shown(const stats::AssistedStatistic& statistic, const stats::AssistedEstimate& estimate) {
    return (statistic.withdrawn ? "withdrawn: " : "") + with_error(estimate.value, estimate.half_width);
}

std::string key(stats::Statistic statistic) {
    return std::string(stats::to_string(statistic));
}

/// Of which population both estimates are, where some cases have no value.
std::string population_line(const Estimators& estimators) {
    return fmt::format(
        "{} of {} cases have no value: the estimates with a model are of the whole box, extrapolated into the settings "
        "that failed; the plain ones are of the cases that answer",
        estimators.without_value, estimators.without_value + estimators.assisted->cases);
}

}  // namespace

Estimators estimators_of(const store::Store& store, const Responses& responses, const ResponseColumn& response) {
    Estimators found;
    const auto refuse = [&](std::string reason) {
        found.refused = "no model-assisted moments: " + std::move(reason);
        return found;
    };
    const auto parts = sample_parts(responses);
    if (!parts.independent) return refuse("they need at least 4 independently randomised sequences");
    std::vector<std::size_t> rows;
    const auto cases = settled_cases(responses, &rows);
    if (rows.empty()) return refuse("no case is settled");
    const auto features =
        cases.features.empty() ? default_features(cases.factors) : written_features(cases.factors, cases.features);
    if (features.names.empty()) return refuse("no factor varies");
    found.features = features.names;
    const auto width = features.names.size();

    const auto points = integration_points(cases, admission(store, cases));
    if (points.empty()) return refuse("the campaign's `where` leaves less than a thirtieth of the box");
    const auto integration = rows_of(features, points);
    if (!std::ranges::all_of(integration, [](double x) { return std::isfinite(x); }))
        return refuse("a feature has no number somewhere in the box");
    std::vector<double> values;
    std::vector<std::size_t> sequences;
    for (const auto row : rows) {
        values.push_back(response.values[row]);
        sequences.push_back(parts.labels[row]);
    }
    const auto at_cases = rows_of(features, cases.settings);
    const auto noise = noise_of(responses, response, rows);
    auto box = box_of(integration, width);
    stats::AssistedSettings settings;
    settings.low = std::move(box.low);
    settings.high = std::move(box.high);
    auto answer = stats::assisted_moments({.points = {at_cases, width},
                                           .values = values,
                                           .sequences = sequences,
                                           .integration = {integration, width},
                                           .scramblings = scramblings,
                                           .noise_variance = noise.variance,
                                           .noise_variance_error = noise.relative_error},
                                          settings);
    if (const auto* refused = std::get_if<stats::Refusal>(&answer)) {
        found.refused = refused->sentence;
        return found;
    }
    found.assisted = std::get<stats::AssistedMoments>(std::move(answer));
    found.scatter_from = noise.from;
    found.without_value = responses.without_value(response);
    return found;
}

store::Table estimators_table(const Estimators& estimators) {
    store::Table table{{"statistic", "plain", "with a model"}, {}};
    const bool scatter_known = !estimators.scatter_from.empty();
    if (scatter_known) table.columns.emplace_back("without scatter");
    if (!estimators.assisted) return table;
    for (const auto statistic : stats::assisted_statistics) {
        const auto& one = estimators.assisted->of(statistic);
        std::vector<store::Table::Cell> row = {key(statistic), with_error(one.plain.value, one.plain.half_width),
                                               shown(one, one.assisted)};
        if (scatter_known) row.emplace_back(shown(one, one.without_scatter));
        table.rows.push_back(std::move(row));
    }
    return table;
}

std::vector<std::string> estimator_lines(const Estimators& estimators) {
    if (!estimators.assisted) return {estimators.refused};
    const auto& assisted = *estimators.assisted;
    std::vector<std::string> lines;
    lines.push_back(fmt::format(
        "the model of {} cases predicts left-out sequences with an error of {:.3f} standard deviations; features: {}",
        assisted.cases, assisted.model_error, campaign::listed(estimators.features)));
    if (!estimators.scatter_from.empty())
        lines.push_back(fmt::format("scatter of single runs, by {}: {:.2g} % of the variance", estimators.scatter_from,
                                    100 * assisted.budget[0].scatter));
    if (estimators.without_value > 0) lines.push_back(population_line(estimators));
    if (!assisted.remark.empty()) lines.push_back(assisted.remark);
    return lines;
}

Json estimators_json(const History& history, const Estimators& estimators) {
    Json plain = Json::object();
    for (const auto statistic : stats::statistics)
        plain[key(statistic)] = json_of(history.all.of(statistic).value, history.all.of(statistic).error);
    Json value = {{"plain", plain}, {"model_assisted", nullptr}, {"without_scatter", nullptr}};
    value["model_error"] = nullptr;
    value["features"] = estimators.features;
    value["scatter_from"] = nullptr;
    value["scatter_share"] = nullptr;
    value["note"] = estimators.refused;
    value["population"] = "";
    if (!estimators.assisted) return value;
    const auto& assisted = *estimators.assisted;
    const bool scatter_known = !estimators.scatter_from.empty();
    for (const auto statistic : stats::assisted_statistics) {
        const auto& one = assisted.of(statistic);
        value["model_assisted"][key(statistic)] = json_of(one.assisted.value, one.assisted.half_width);
        value["model_assisted"][key(statistic)]["taken"] = one.takes_assisted;
        value["model_assisted"][key(statistic)]["withdrawn"] = one.withdrawn;
        if (!scatter_known) continue;
        value["without_scatter"][key(statistic)] = json_of(one.without_scatter.value, one.without_scatter.half_width);
        value["without_scatter"][key(statistic)]["withdrawn"] = one.withdrawn;
    }
    value["model_error"] = json_number(assisted.model_error);
    value["note"] = assisted.remark;
    if (estimators.without_value > 0) value["population"] = population_line(estimators);
    if (!scatter_known) return value;
    value["scatter_from"] = estimators.scatter_from;
    const auto share = [&](std::size_t p) {
        const auto& budget = assisted.budget[p];
        return json_number(budget.scatter / (budget.response + budget.scatter));
    };
    value["scatter_share"] = {{"variance", share(0)}, {"third_moment", share(1)}, {"fourth_moment", share(2)}};
    return value;
}

}  // namespace grainsweep::report
