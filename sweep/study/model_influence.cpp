#include "sweep/study/model_influence.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/joint_column.hpp"
#include "sweep/study/box_search.hpp"
#include "sweep/study/sample_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

namespace grainsweep::study {
namespace {

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

stats::FactorRoles roles_of(const std::vector<ModelFactor>& factors, const std::vector<std::size_t>& varied) {
    stats::FactorRoles roles;
    for (const auto j : varied) {
        roles.noise.push_back(factors[j].noise);
        roles.levels.push_back(factors[j].is_word() ? factors[j].words.size() : factors[j].numbers.size());
        const auto* column = campaign::column_of(factors[j].distribution());
        roles.together.push_back(column == nullptr ? std::nullopt : std::optional(*column));
    }
    return roles;
}

/// "between 0.005 and 0.006", "at fine".
std::string part_of_range(const ModelFactor& factor, double from, double to) {
    const auto at = [&](double u) {
        const double x = exact_setting(std::span(&factor, 1), {&u, 1}).front();
        return fmt::format("{:.4g}", std::clamp(x, factor.low(), factor.high()));
    };
    const double middle = (from + to) / 2;
    if (factor.is_word()) return "at " + factor.text(exact_setting(std::span(&factor, 1), {&middle, 1}).front());
    if (!factor.numbers.empty()) return "at " + at(middle);
    const auto low = at(from), high = at(to);
    return low == high ? "at " + low : fmt::format("between {} and {}", low, high);
}

void describe_noise(ModelInfluence& found, const std::vector<ModelFactor>& factors,
                    const std::vector<std::size_t>& varied) {
    for (const auto j : varied)
        if (factors[j].noise) found.noise.push_back(factors[j].name);
    for (const auto& one : found.indices->noise->controls)
        found.calmest.push_back(part_of_range(factors[varied[one.factor]], one.from, one.to));
}

/// Why a campaign has no indices of a model; empty: nothing speaks against them.
std::string reason_against_indices(const Responses& responses) {
    if (responses.dropped() > 0)
        return "the campaign's `where` leaves a part of the box out, and a model has no cases there";
    if (std::ranges::find(responses.group_names, campaign::group_of_shares) != responses.group_names.end())
        return "shares that add to one do not vary by themselves, as the indices of a model suppose";
    return {};
}

ModelInfluence refused_indices(std::string reason) {
    ModelInfluence none;
    none.refused = std::move(reason);
    return none;
}

}  // namespace

ModelInfluence model_influence_of(const Responses& responses, const ResponseColumn& response,
                                  const ObservableModel& model) {
    if (auto reason = reason_against_indices(responses); !reason.empty()) return refused_indices(std::move(reason));
    const auto* response_model = std::get_if<stats::ResponseModel>(&model.model);
    if (response_model == nullptr)
        return refused_indices("the values are 0 and 1 alone: the model of their probability has no indices");
    ModelInfluence found;
    std::vector<std::size_t> rows, varied;
    const auto cases = settled_cases(responses, &rows);
    for (std::size_t j = 0; j < cases.factors.size(); ++j)
        if (cases.factors[j].varies()) varied.push_back(j);
    for (const auto j : varied) found.factors.push_back(cases.factors[j].name);
    for (const auto j : varied)
        if (!responses.factors[j].shares.empty()) found.dependent.push_back(cases.factors[j].name);
    found.model = model;
    found.without_value = responses.without_value(response);
    // Imported cases belong to no part of the sample.
    const auto groups = responses.imported.empty() ? groups_of(responses, rows) : std::vector<std::size_t>{};
    found.indices = stats::model_indices(*response_model, varied.size(), groups,
                                         model_map(model, cases.factors, varied), roles_of(cases.factors, varied));
    if (found.depends() && found.indices->shapley.empty())
        return refused_indices(
            fmt::format("{} are columns of one sample and depend on each other; Shapley effects are "
                        "computed for at most {} varied factors",
                        campaign::listed(found.dependent), stats::most_shared_factors));
    if (found.indices->noise) describe_noise(found, cases.factors, varied);
    return found;
}

ModelInfluence model_influence_of(const Responses& responses, const ResponseColumn& response) {
    if (auto reason = reason_against_indices(responses); !reason.empty()) return refused_indices(std::move(reason));
    const auto cases = settled_and_imported_cases(responses);
    auto learned = learn(cases, cases.observable(response.name));
    if (auto* refused = std::get_if<stats::Refusal>(&learned)) return refused_indices(std::move(refused->sentence));
    return model_influence_of(responses, response, std::get<ObservableModel>(learned));
}

}  // namespace grainsweep::study
