#include "sweep/study/estimators.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/designs/design.hpp"
#include "sweep/study/box_search.hpp"
#include "sweep/study/effects.hpp"
#include "sweep/study/response_models.hpp"
#include "sweep/study/sample_parts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace grainsweep::study {
namespace {

constexpr std::size_t scramblings = 4, points_each = 8192, least_points_each = 256;
constexpr std::uint64_t seed_of_integration = 0x696e746567726174;  // of no campaign: its points are not among the cases
constexpr std::int64_t least_repeated = 100;

/// Points of the box, one scrambling after the other, all of one size; none where `where` leaves too small a part.
std::vector<Setting> integration_points(const ModelCases& cases, const Admits& admits) {
    const auto set = sobol_points({.levels = std::vector<std::size_t>(cases.factors.size(), 0),
                                   .options = {{"scramble", std::string("random")},
                                               {"sequences", static_cast<std::int64_t>(scramblings)},
                                               {"points", static_cast<std::int64_t>(scramblings * points_each)}},
                                   .seed = seed_of_integration});
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

}  // namespace

Estimators estimators_of(const store::Store& store, const Responses& responses, const ResponseColumn& response,
                         std::span<const stats::Level> levels) {
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
    settings.levels = levels;
    auto answer = stats::assisted_moments({.points = {at_cases, width},
                                           .values = values,
                                           .sequences = sequences,
                                           .integration = {integration, width},
                                           .scramblings = scramblings,
                                           .noise_variance = noise.variance,
                                           .noise_variance_error = noise.relative_error,
                                           .failed = responses.settled - rows.size()},
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

}  // namespace grainsweep::study
