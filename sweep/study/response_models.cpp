#include "sweep/study/response_models.hpp"

#include "stats/nearest_cases.hpp"
#include "sweep/campaign/expressions.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/campaign/stored_text.hpp"
#include "sweep/campaign/wrong_question.hpp"
#include "sweep/store/expression.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <limits>
#include <numbers>
#include <set>

namespace grainsweep::study {
namespace {

constexpr std::size_t cases_in_trial = 300, most_trials = 6;
constexpr double worth_a_ratio = 0.95;  // of the leave-one-out error without it

bool asks_the_same(const campaign::Identity& a, const campaign::Identity& b) {
    return a.scene == b.scene && a.revision == b.revision && a.factors == b.factors && a.fixed == b.fixed;
}

bool answered(const std::optional<campaign::Outcome>& outcome) {
    return outcome == campaign::Outcome::completed || outcome == campaign::Outcome::skipped;
}

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
        if (!answered(responses.outcomes[row])) {
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
        if (!asks_the_same(record, first)) others.push_back(record.name);
    if (name.empty() && !others.empty()) {
        others.insert(others.begin(), first.name);
        throw campaign::wrong_question("--campaign", "", fmt::format("which of {}?", campaign::listed(others)));
    }
    std::erase_if(records,
                  [&](const auto& record) { return record.name == first.name || !asks_the_same(record, first); });
    records.insert(records.begin(), first);
    return records;
}

stats::ResponseModelOptions boxed(std::span<const double> rows, std::size_t width) {
    auto box = box_of(rows, width);
    stats::ResponseModelOptions options;
    options.low = std::move(box.low);
    options.high = std::move(box.high);
    return options;
}

/// Leave-one-out error on some of the cases, the same for every set of features; infinite where there is none.
double trial_error(const Features& features, const ModelCases& cases, const ResponseColumn& observable) {
    std::vector<std::size_t> usable;
    for (std::size_t i = 0; i < cases.settings.size(); ++i)
        if (std::isfinite(observable.values[i])) usable.push_back(i);
    std::vector<Setting> settings;
    std::vector<double> values;
    for (const auto i : random_rows(usable, cases_in_trial)) {
        settings.push_back(cases.settings[i]);
        values.push_back(observable.values[i]);
    }
    const auto rows = rows_of(features, settings);
    auto options = boxed(rows, features.names.size());
    options.map = stats::LearnedMap::never;
    options.starts = 3;
    options.refused_error = std::numeric_limits<double>::infinity();
    const auto fit = stats::fit_response({rows, features.names.size()}, values, options);
    const auto* model = std::get_if<stats::ResponseModel>(&fit);
    return model == nullptr ? std::numeric_limits<double>::infinity() : model->quality().leave_one_out_error;
}

/// Features by default, with that ratio of two factors in them that lowers the error most, if one does.
Features with_ratios_tried(const ModelCases& cases, const ResponseColumn& observable, std::vector<std::string>& notes) {
    Features features = default_features(cases.factors);
    auto ratios = candidate_ratios(cases.factors);
    if (ratios.empty()) return features;
    if (ratios.size() > most_trials) ratios.resize(most_trials);
    const double plain = trial_error(features, cases, observable);
    double best = worth_a_ratio * plain;
    std::string kept;
    for (const auto& ratio : ratios) {
        auto tried = default_features(cases.factors, std::span(&ratio, 1));
        const double error = trial_error(tried, cases, observable);
        if (!(error < best)) continue;
        best = error;
        features = std::move(tried);
        kept = fmt::format("log({}/{})", cases.factors[ratio.over].name, cases.factors[ratio.under].name);
    }
    if (!kept.empty())
        notes.push_back(fmt::format(
            "{} is a feature: leave-one-out error {:.3f} with it, {:.3f} without it, on {} cases without a learned map",
            kept, best, plain, std::min(cases.settings.size(), cases_in_trial)));
    return features;
}

/// Rows in widths of the box.
std::vector<double> scaled(std::vector<double> rows, std::size_t width, const stats::ResponseModelOptions& box) {
    for (std::size_t i = 0; i < rows.size(); ++i)
        rows[i] = (rows[i] - box.low[i % width]) / (box.high[i % width] - box.low[i % width]);
    return rows;
}

double share_of_nearest(std::span<const double> point, std::span<const double> rows, const std::vector<bool>& defined) {
    const auto width = point.size(), n = defined.size();
    std::vector<std::pair<double, std::size_t>> near(n);
    for (std::size_t i = 0; i < n; ++i) near[i] = {stats::squared_distance(point, rows.subspan(i * width, width)), i};
    const auto k = std::min(n, static_cast<std::size_t>(std::max(8.0, std::sqrt(static_cast<double>(n)) / 1.5)));
    const auto end = near.begin() + static_cast<std::ptrdiff_t>(k);
    std::ranges::nth_element(near, end - 1);
    const auto those = std::count_if(near.begin(), end, [&](const auto& one) { return defined[one.second]; });
    const auto all = static_cast<double>(std::ranges::count(defined, true)) / static_cast<double>(n);
    return (static_cast<double>(those) + all) / (static_cast<double>(k) + 1);
}

/// The model of b of the header; none where it is refused.
std::optional<stats::ResponseModel> learn_boundary(std::span<const double> rows, std::size_t width,
                                                   const std::vector<bool>& defined) {
    const auto box = boxed(rows, width);
    const auto places = scaled({rows.begin(), rows.end()}, width, box);
    const auto row = [&](std::size_t i) { return std::span(places).subspan(i * width, width); };
    std::vector<double> distance;
    for (std::size_t i = 0; i < defined.size(); ++i) {
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k < defined.size(); ++k)
            if (defined[k] != defined[i]) nearest = std::min(nearest, stats::squared_distance(row(i), row(k)));
        distance.push_back((defined[i] ? 1 : -1) * std::sqrt(nearest));
    }
    auto fit = stats::fit_response({rows, width}, distance, box);
    if (auto* model = std::get_if<stats::ResponseModel>(&fit)) return std::move(*model);
    return std::nullopt;
}

std::optional<stats::Refusal> undefined_feature(const Features& features, const ModelCases& cases,
                                                std::span<const double> rows) {
    const auto bad = std::ranges::find_if_not(rows, [](double x) { return std::isfinite(x); });
    if (bad == rows.end()) return std::nullopt;
    const auto place = static_cast<std::size_t>(bad - rows.begin());
    const auto width = features.names.size();
    return stats::Refusal{fmt::format("the feature '{}' has no number at {}", features.names[place % width],
                                      setting_text(cases.factors, cases.settings[place / width]))};
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

ModelCases read_model_cases(const store::Store& store, std::string_view name) {
    const auto records = chosen_campaigns(store, name);
    ModelCases cases;
    std::set<std::string> seen;
    for (const auto& record : records) {
        const auto responses = read_responses(store, record);
        if (cases.campaign.name.empty()) cases = without_cases(responses);
        const auto before = cases.settings.size();
        add_model_cases(cases, responses, seen);
        if (record.name != cases.campaign.name && cases.settings.size() > before) cases.further.push_back(record.name);
    }
    return cases;
}

ModelCases settled_cases(const Responses& responses, std::vector<std::size_t>* rows) {
    ModelCases cases = without_cases(responses);
    const auto settings = settings_of(responses, cases.factors);
    for (std::size_t row = 0; row < responses.settled; ++row) {
        if (!answered(responses.outcomes[row])) {
            cases.failed.push_back({settings[row], *responses.outcomes[row]});
            continue;
        }
        if (cases.case_id.empty()) cases.case_id = responses.case_ids[row];
        cases.settings.push_back(settings[row]);
        for (std::size_t k = 0; k < cases.observables.size(); ++k)
            cases.observables[k].values.push_back(responses.observables[k].values[row]);
        if (rows != nullptr) rows->push_back(row);
    }
    return cases;
}

std::vector<double> ObservableModel::rows(std::span<const Setting> settings) const {
    return rows_of(features, settings);
}

std::vector<stats::Prediction> ObservableModel::predict(std::span<const Setting> settings) const {
    const auto asked = rows(settings);
    return model.predict({asked, features.names.size()});
}

std::vector<double> ObservableModel::defined(std::span<const Setting> settings) const {
    if (undefined == 0) return std::vector<double>(settings.size(), 1);
    const auto asked = rows(settings);
    const auto width = features.names.size();
    std::vector<double> probability;
    if (boundary) {
        for (const auto& p : boundary->predict({asked, width}))
            probability.push_back(0.5 * std::erfc(-p.mean / (p.run_error() * std::numbers::sqrt2)));
        return probability;
    }
    const auto near = scaled(case_features, width, boxed(case_features, width));
    const auto there = scaled(asked, width, boxed(case_features, width));
    for (std::size_t i = 0; i < settings.size(); ++i)
        probability.push_back(share_of_nearest({there.data() + i * width, width}, near, case_defined));
    return probability;
}

std::variant<ObservableModel, stats::Refusal> learn(const ModelCases& cases, const ResponseColumn& observable) {
    std::vector<std::string> notes;
    Features features = cases.features.empty() ? with_ratios_tried(cases, observable, notes)
                                               : written_features(cases.factors, cases.features);
    if (features.names.empty()) return stats::Refusal{"no factor varies"};
    const auto rows = rows_of(features, cases.settings);
    if (auto refused = undefined_feature(features, cases, rows)) return std::move(*refused);
    const auto width = features.names.size();
    std::vector<bool> defined;
    for (const double value : observable.values) defined.push_back(std::isfinite(value));
    const auto undefined = static_cast<std::size_t>(std::ranges::count(defined, false));
    std::future<std::optional<stats::ResponseModel>> boundary;  // learned beside the model
    if (undefined > 0) boundary = std::async(std::launch::async, [&] { return learn_boundary(rows, width, defined); });
    auto options = boxed(rows, width);
    options.logarithm = stats::LogResponse::where_better;
    auto fit = stats::fit_response({rows, width}, observable.values, options);
    if (auto* refused = std::get_if<stats::Refusal>(&fit)) return std::move(*refused);
    ObservableModel learned{observable.name,
                            observable.unit,
                            std::move(features),
                            std::get<stats::ResponseModel>(fit),
                            0,
                            std::move(notes),
                            rows,
                            {},
                            std::nullopt};
    if (undefined > 0) learned.boundary = boundary.get();
    learned.undefined = undefined;
    learned.case_defined = std::move(defined);
    const auto& quality = learned.model.quality();
    if (quality.logarithm)
        learned.notes.push_back(fmt::format(
            "the model is one of log({}): leave-one-out error {:.3f} with it, {:.3f} without it, on {} cases",
            learned.observable, quality.error_with_logarithm, quality.error_without_logarithm,
            std::min(quality.cases, stats::cases_compared)));
    if (quality.rests_on < quality.cases)
        learned.notes.push_back(fmt::format("the model rests on {} of {} cases, chosen to fill the space",
                                            quality.rests_on, quality.cases));
    if (learned.undefined > 0)
        learned.notes.push_back(fmt::format("'{}' is undefined in {} of {} answered cases, which the model leaves out",
                                            learned.observable, learned.undefined, observable.values.size()));
    if (!cases.failed.empty())
        learned.notes.push_back(fmt::format("{} failed cases are left out", cases.failed.size()));
    if (!cases.further.empty())
        learned.notes.push_back(fmt::format("cases of {} are in the model, too", campaign::listed(cases.further)));
    return learned;
}

ObservableModel learn_or_refuse(const ModelCases& cases, const ResponseColumn& observable) {
    auto learned = learn(cases, observable);
    if (auto* refused = std::get_if<stats::Refusal>(&learned)) {
        throw campaign::wrong_question(
            fmt::format("campaign {}, observable '{}'", cases.campaign.name, observable.name), "",
            refused->sentence.starts_with("no response model") ? refused->sentence
                                                               : "no response model: " + refused->sentence);
    }
    return std::get<ObservableModel>(std::move(learned));
}

std::function<bool(const Setting&)> admission(const store::Store& store, const ModelCases& cases) {
    const auto example = cases.case_id.empty() ? std::nullopt : store.find_case(cases.case_id);
    const auto* scene = find_scene(cases.campaign.scene);
    if (cases.campaign.condition.empty() || !example || scene == nullptr) return {};
    Inputs inputs = example->inputs;
    for (const auto& [name, value] : scene->defaults()) inputs.try_emplace(name, value);
    std::vector<std::string> names;
    for (const auto& [name, value] : inputs) names.push_back(name);
    campaign::Filter filter;
    try {
        filter = store::make_filter(cases.campaign.condition, names);
    } catch (const campaign::WrongQuestion&) {  // an older program took what is refused today
        return {};
    }
    return [inputs, factors = cases.factors, expressions = campaign::expressions_of(cases.campaign, *scene),
            filter](const Setting& setting) mutable {
        for (std::size_t j = 0; j < factors.size(); ++j)
            inputs[factors[j].name] = campaign::coerced(factors[j].value(setting[j]), inputs.at(factors[j].name));
        campaign::evaluate_expressions(expressions, inputs);
        return filter(inputs);
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
        if (factor.is_word() || (setting[j] >= factor.low && setting[j] <= factor.high)) continue;
        text += fmt::format("{}{} = {} is outside of {} to {}", text.empty() ? "" : ", ", factor.name, setting[j],
                            factor.low, factor.high);
    }
    return text;
}

}  // namespace grainsweep::study
