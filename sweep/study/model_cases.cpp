#include "sweep/study/model_cases.hpp"

#include "sweep/campaign/expressions.hpp"
#include "sweep/campaign/forecast.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/campaign/stored_text.hpp"
#include "sweep/store/expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

namespace grainsweep::study {
namespace {

constexpr double rounding_of_shares = 1e-9;

/// What is asked, and no case yet.
ModelCases without_cases(const Responses& responses) {
    ModelCases cases;
    cases.campaign = responses.campaign;
    cases.factors = model_factors(responses);
    cases.features = campaign::remarks_in(responses.campaign.text).features;
    cases.observables = responses.observables;
    for (auto& column : cases.observables) column.values.clear();
    if (const auto* main = responses.main_observable()) cases.main = main->name;
    return cases;
}

/// The index of every word of `from` in `to`; none where `to` has it not.
std::optional<double> same_word(const ModelFactor& from, const ModelFactor& to, double index) {
    const auto& word = from.words.at(static_cast<std::size_t>(index));
    const auto found = std::ranges::find(to.words, word);
    if (found == to.words.end()) return std::nullopt;
    return static_cast<double>(found - to.words.begin());
}

void add_model_cases(ModelCases& cases, const Responses& responses, std::set<std::string>& seen) {
    const auto factors = model_factors(responses);
    const auto settings = settings_of(responses, factors);
    for (std::size_t row = 0; row < responses.rows(); ++row) {
        if (!has_final_outcome(responses.outcomes[row]) || !seen.insert(responses.case_ids[row]).second) continue;
        Setting setting = settings[row];
        bool known = true;
        for (std::size_t j = 0; j < factors.size(); ++j) {
            if (!factors[j].is_word()) continue;
            const auto index = same_word(factors[j], cases.factors[j], setting[j]);
            known = known && index;
            setting[j] = index.value_or(0);
        }
        if (!known) continue;
        if (has_failed(responses.outcomes[row])) {
            cases.failed.push_back({std::move(setting), *responses.outcomes[row]});
            continue;
        }
        if (cases.case_id.empty()) cases.case_id = responses.case_ids[row];
        cases.settings.push_back(std::move(setting));
        for (auto& column : cases.observables) {
            const auto found = std::ranges::find(responses.observables, column.name, &ResponseColumn::name);
            column.values.push_back(found == responses.observables.end() ? std::numeric_limits<double>::quiet_NaN()
                                                                         : found->values[row]);
        }
    }
}

std::vector<store::CampaignRecord> chosen_campaigns(const store::Store& store, std::string_view name) {
    auto records = find_campaigns(store, {});
    const auto first = name.empty() ? records.front() : find_campaigns(store, name).front();
    std::vector<std::string> others;
    for (const auto& record : records)
        if (!campaign::asks_the_same(record, first)) others.push_back(record.name);
    if (name.empty() && !others.empty()) {
        others.insert(others.begin(), first.name);
        throw campaign::input_error("--campaign", "", fmt::format("which of {}?", campaign::listed(others)));
    }
    std::erase_if(records, [&](const auto& record) {
        return record.name == first.name || !campaign::asks_the_same(record, first);
    });
    records.insert(records.begin(), first);
    return records;
}

/// Complete inputs of settings; empty where no case is answered.
std::function<Inputs(const Setting&)> completion(const store::Store& store, const ModelCases& cases) {
    const auto example = cases.case_id.empty() ? std::nullopt : store.find_case(cases.case_id);
    const auto scene = find_scene(cases.campaign.scene);
    if (!example || scene == nullptr) return {};
    Inputs inputs = example->inputs;
    for (const auto& [name, value] : scene->defaults()) inputs.try_emplace(name, value);
    return [inputs, factors = cases.factors,
            expressions = campaign::expressions_of(cases.campaign, *scene)](const Setting& asked) mutable {
        Setting setting = asked;
        fold(factors, setting);
        for (std::size_t j = 0; j < factors.size(); ++j)
            inputs[factors[j].name] = campaign::coerced(factors[j].value_of(setting[j]), inputs.at(factors[j].name));
        campaign::evaluate_expressions(expressions, inputs);
        return inputs;
    };
}

/// The scene's own check, where it explains a rejected case and refuses no answered one.
std::function<bool(const Setting&)> possibility(const store::Store& store, const ModelCases& cases) {
    using campaign::Outcome;
    if (std::ranges::find(cases.failed, Outcome::rejected, &FailedCase::outcome) == cases.failed.end()) return {};
    const auto complete = completion(store, cases);
    if (!complete) return {};
    const std::function<bool(const Setting&)> possible =
        [complete, check = campaign::acceptance(*find_scene(cases.campaign.scene))](const Setting& setting) {
            return check(complete(setting));
        };
    const bool explains = std::ranges::any_of(cases.failed, [&](const FailedCase& one) {
        return one.outcome == Outcome::rejected && !possible(one.setting);
    });
    if (!explains || !std::ranges::all_of(cases.settings, possible)) return {};
    return possible;
}

}  // namespace

const ResponseColumn& ModelCases::observable(std::string_view name) const {
    return named_observable(observables, name.empty() ? std::string_view(main) : name, campaign);
}

std::vector<std::string> ModelCases::observable_names() const {
    std::vector<std::string> names;
    for (const auto& column : observables) names.push_back(column.name);
    return names;
}

std::vector<std::string> ModelCases::factor_names() const {
    std::vector<std::string> names;
    for (const auto& factor : factors) names.push_back(factor.name);
    return names;
}

ModelCases read_model_cases(const store::Store& store, std::string_view name,
                            std::span<const campaign::Outcome> left_out) {
    const auto records = chosen_campaigns(store, name);
    ModelCases cases;
    std::set<std::string> seen;
    for (const auto& record : records) {
        const auto responses = read_responses(store, record);
        if (cases.campaign.name.empty()) cases = without_cases(responses);
        const auto before = cases.settings.size();
        add_model_cases(cases, responses, seen);
        if (record.name != cases.campaign.name && cases.settings.size() > before) cases.further.push_back(record.name);
        cases.sources.resize(cases.settings.size(), cases.further.size());
    }
    cases.left_out.assign(left_out.begin(), left_out.end());
    cases.cases_left_out = std::erase_if(cases.failed, [&](const FailedCase& one) {
        return std::ranges::find(left_out, one.outcome) != left_out.end();
    });
    cases.possible = possibility(store, cases);
    return cases;
}

ModelCases settled_cases(const Responses& responses, std::vector<std::size_t>* rows) {
    ModelCases cases = without_cases(responses);
    const auto settings = settings_of(responses, cases.factors);
    for (std::size_t row = 0; row < responses.settled; ++row) {
        if (has_failed(responses.outcomes[row])) {
            cases.failed.push_back({settings[row], *responses.outcomes[row]});
            continue;
        }
        if (cases.case_id.empty()) cases.case_id = responses.case_ids[row];
        cases.settings.push_back(settings[row]);
        cases.sources.push_back(0);
        for (std::size_t k = 0; k < cases.observables.size(); ++k)
            cases.observables[k].values.push_back(responses.observables[k].values[row]);
        if (rows != nullptr) rows->push_back(row);
    }
    return cases;
}

ModelCases settled_and_imported_cases(const Responses& responses) {
    auto cases = settled_cases(responses);
    std::set<std::string> seen(responses.case_ids.begin(), responses.case_ids.end());
    for (const auto& imported : responses.imported) {
        const auto before = cases.settings.size();
        add_model_cases(cases, imported, seen);
        if (cases.settings.size() > before) cases.further.push_back(imported.campaign.name);
        cases.sources.resize(cases.settings.size(), cases.further.size());
    }
    return cases;
}

std::function<bool(const Setting&)> admission(const store::Store& store, const ModelCases& cases) {
    const auto shares_fit = [factors = cases.factors](const Setting& setting) {
        return std::abs(sum_of_shares(factors, setting).value_or(1) - 1) <= rounding_of_shares;
    };
    const bool shares = std::ranges::any_of(cases.factors, &ModelFactor::share);
    const auto by_shares = shares ? std::function<bool(const Setting&)>(shares_fit) : nullptr;
    const auto complete = completion(store, cases);
    if (cases.campaign.condition.empty() || !complete || cases.settings.empty()) return by_shares;
    std::vector<std::string> names;
    for (const auto& [name, value] : complete(cases.settings.front())) names.push_back(name);
    campaign::Filter filter;
    try {
        filter = store::make_filter(cases.campaign.condition, names);
    } catch (const campaign::InputError&) {  // an older version accepted a setting that is refused now
        return by_shares;
    }
    return [complete, filter, shares_fit](const Setting& setting) {
        return shares_fit(setting) && filter(complete(setting));
    };
}

std::string setting_text(std::span<const ModelFactor> factors, const Setting& setting) {
    std::string text;
    for (std::size_t j = 0; j < factors.size(); ++j)
        text += fmt::format("{}{} = {}", j == 0 ? "" : ", ", factors[j].name, factors[j].text(setting[j]));
    return text;
}

std::string outside_text(std::span<const ModelFactor> factors, const Setting& setting) {
    std::string text;
    for (std::size_t j = 0; j < factors.size(); ++j) {
        const auto& factor = factors[j];
        if (factor.is_word() || (factor.counts && !factor.counts(setting)) ||
            (setting[j] >= factor.low() && setting[j] <= factor.high()))
            continue;
        text += fmt::format("{}{} = {} is outside of {} to {}", text.empty() ? "" : ", ", factor.name, setting[j],
                            factor.low(), factor.high());
    }
    const auto sum = sum_of_shares(factors, setting);
    if (sum && std::abs(*sum - 1) > rounding_of_shares)
        text += fmt::format("{}the shares add to {:.6g}, not to 1", text.empty() ? "" : ", ", *sum);
    return text;
}

std::string between_levels_text(std::span<const ModelFactor> factors, std::span<const Setting> settings) {
    for (const auto& setting : settings)
        for (std::size_t j = 0; j < factors.size(); ++j) {
            const auto& factor = factors[j];
            const auto& levels = factor.numbers;
            const double x = setting[j];
            if (levels.empty() || std::isnan(x) || std::ranges::find(levels, x) != levels.end()) continue;
            return fmt::format(
                "{} = {} is no level of the campaign: between levels the model assumes a smooth "
                "response, and its errors do not cover what was not run there",
                factor.name, factor.text(x));
        }
    return {};
}

}  // namespace grainsweep::study
