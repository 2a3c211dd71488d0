#include "sweep/study/response_models.hpp"

#include "sweep/campaign/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <future>
#include <limits>
#include <set>

namespace grainsweep::study {
namespace {

constexpr std::size_t cases_in_trial = 300, most_trials = 6;
constexpr double worth_a_ratio = 0.95;     // of the leave-one-out error without it
constexpr double barely_explained = 0.95;  // leave-one-out error in standard deviations: 10 % of the variance

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

/// The model of whether a case has a value.
std::optional<stats::ProbabilityModel> learn_defined(std::span<const double> rows, std::size_t width,
                                                     std::span<const double> values) {
    std::vector<double> defined;
    for (const double value : values) defined.push_back(std::isfinite(value) ? 1 : 0);
    const auto box = box_of(rows, width);
    auto fit = stats::fit_probability({rows, width}, defined, box.low, box.high);
    if (auto* model = std::get_if<stats::ProbabilityModel>(&fit)) return std::move(*model);
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

std::vector<double> ObservableModel::rows(std::span<const Setting> settings) const {
    return rows_of(features, settings);
}

std::vector<stats::Prediction> ObservableModel::predict(std::span<const Setting> settings) const {
    const auto asked = rows(settings);
    return std::visit([&](const auto& one) { return one.predict(stats::Rows{asked, features.names.size()}); }, model);
}

std::vector<double> ObservableModel::means(std::span<const double> asked) const {
    const stats::Rows points{asked, features.names.size()};
    if (const auto* probability = std::get_if<stats::ProbabilityModel>(&model))
        return probability->probabilities(points);
    return std::get<stats::ResponseModel>(model).means(points);
}

std::vector<double> ObservableModel::defined(std::span<const Setting> settings) const {
    if (!has_a_value) return std::vector<double>(settings.size(), 1);
    const auto asked = rows(settings);
    return has_a_value->probabilities({asked, features.names.size()});
}

ObservableModel ObservableModel::with_case(const Setting& setting, double response) const {
    const auto row = rows(std::span(&setting, 1));
    ObservableModel longer = *this;
    std::visit([&](auto& one) { one = one.with_cases({row, row.size()}, std::span(&response, 1)); }, longer.model);
    return longer;
}

std::size_t ObservableModel::cases() const {
    return std::visit([](const auto& one) { return one.quality().cases; }, model);
}

std::vector<double> ObservableModel::scores() const {
    std::vector<double> scores;
    if (const auto* response = std::get_if<stats::ResponseModel>(&model)) {
        const auto& quality = response->quality();
        for (std::size_t i = 0; i < quality.residuals.size(); ++i)
            scores.push_back(quality.residuals[i] / quality.errors[i]);
    }
    return scores;
}

double ObservableModel::freedom() const {
    if (const auto* response = std::get_if<stats::ResponseModel>(&model)) return response->freedom();
    return std::numeric_limits<double>::infinity();
}

namespace {

using FittedModel = std::variant<stats::ResponseModel, stats::ProbabilityModel>;

/// A probability's own model where the response is one.
std::variant<FittedModel, stats::Refusal> fitted(std::span<const double> rows, std::size_t width,
                                                 std::span<const double> values, Unexplained unexplained) {
    auto options = boxed(rows, width);
    if (unexplained == Unexplained::scatter) options.refused_error = std::numeric_limits<double>::infinity();
    if (stats::only_zero_and_one(values)) {
        auto fit = stats::fit_probability({rows, width}, values, options.low, options.high);
        if (auto* refused = std::get_if<stats::Refusal>(&fit)) return std::move(*refused);
        return FittedModel(std::get<stats::ProbabilityModel>(std::move(fit)));
    }
    options.logarithm = stats::LogResponse::where_better;
    auto fit = stats::fit_response({rows, width}, values, options);
    if (auto* refused = std::get_if<stats::Refusal>(&fit)) return std::move(*refused);
    return FittedModel(std::get<stats::ResponseModel>(std::move(fit)));
}

void note_quality(ObservableModel& learned) {
    const auto* model = std::get_if<stats::ResponseModel>(&learned.model);
    if (model == nullptr) return;
    const auto& quality = model->quality();
    if (quality.leave_one_out_error >= stats::ResponseModelOptions{}.refused_error)
        learned.notes.push_back(fmt::format(
            "the factors explain {} of '{}' ({} cases, left-out ones predicted with an error of {:.2f} standard "
            "deviations): the model counts the rest as {}",
            quality.leave_one_out_error < barely_explained ? "little" : "nothing", learned.observable, quality.cases,
            quality.leave_one_out_error,
            quality.noise == stats::Noise::misfit ? "its error" : "scatter of single runs"));
    if (quality.noise == stats::Noise::misfit)
        learned.notes.push_back(fmt::format(
            "runs of one setting do not differ in '{}': what the model does not follow counts as error of the mean",
            learned.observable));
    if (quality.logarithm)
        learned.notes.push_back(fmt::format(
            "the model is one of log({}): leave-one-out error {:.3f} with it, {:.3f} without it, on {} cases",
            learned.observable, quality.error_with_logarithm, quality.error_without_logarithm,
            std::min(quality.cases, stats::cases_compared)));
    if (quality.rests_on < quality.cases)
        learned.notes.push_back(fmt::format("the model rests on {} of {} cases, chosen to fill the space",
                                            quality.rests_on, quality.cases));
}

/// Notes factors that could have any number and have few in the cases: their response between these is a guess.
void note_few_values(ObservableModel& learned, const ModelCases& cases) {
    constexpr std::size_t few = 8;
    std::vector<std::string> names;
    for (std::size_t j = 0; j < cases.factors.size(); ++j) {
        const auto& factor = cases.factors[j];
        if (factor.is_word() || !factor.numbers.empty() || factor.step) continue;
        std::set<double> values;
        for (const auto& setting : cases.settings)
            if (!std::isnan(setting[j])) values.insert(setting[j]);
        if (values.size() < few) names.push_back(fmt::format("{} ({})", factor.name, values.size()));
    }
    if (!names.empty())
        learned.notes.push_back(
            fmt::format("the cases have few values of {}: between them the model assumes that '{}' is smooth, and its "
                        "errors do not cover what was not run there",
                        campaign::listed(names), learned.observable));
}

}  // namespace

std::variant<ObservableModel, stats::Refusal> learn(const ModelCases& cases, const ResponseColumn& observable,
                                                    Unexplained unexplained) {
    std::vector<std::string> notes;
    const bool probability = stats::only_zero_and_one(observable.values);
    Features features = !cases.features.empty() ? written_features(cases.factors, cases.features)
                        : probability           ? default_features(cases.factors)
                                                : with_ratios_tried(cases, observable, notes);
    if (features.names.empty()) return stats::Refusal{"no factor varies"};
    const auto rows = rows_of(features, cases.settings);
    if (auto refused = undefined_feature(features, cases, rows)) return std::move(*refused);
    const auto width = features.names.size();
    const auto undefined = static_cast<std::size_t>(
        std::ranges::count_if(observable.values, [](double value) { return !std::isfinite(value); }));
    std::future<std::optional<stats::ProbabilityModel>> has_a_value;  // learned beside the model
    if (undefined > 0)
        has_a_value = std::async(std::launch::async, [&] { return learn_defined(rows, width, observable.values); });
    auto fit = fitted(rows, width, observable.values, unexplained);
    if (auto* refused = std::get_if<stats::Refusal>(&fit)) return std::move(*refused);
    ObservableModel learned{observable.name,
                            observable.unit,
                            std::move(features),
                            std::get<FittedModel>(std::move(fit)),
                            undefined,
                            std::move(notes),
                            rows,
                            std::nullopt};
    if (undefined > 0) learned.has_a_value = has_a_value.get();
    note_quality(learned);
    note_few_values(learned, cases);
    if (learned.undefined > 0)
        learned.notes.push_back(fmt::format("'{}' is undefined in {} of {} answered cases, which the model leaves out",
                                            learned.observable, learned.undefined, observable.values.size()));
    if (!cases.failed.empty())
        learned.notes.push_back(fmt::format("{} failed cases have no value", cases.failed.size()));
    if (!cases.further.empty())
        learned.notes.push_back(fmt::format("cases of {} are in the model, too", campaign::listed(cases.further)));
    return learned;
}

ObservableModel learn_or_refuse(const ModelCases& cases, const ResponseColumn& observable, Unexplained unexplained) {
    auto learned = learn(cases, observable, unexplained);
    if (auto* refused = std::get_if<stats::Refusal>(&learned)) {
        throw campaign::input_error(
            fmt::format("campaign {}, observable '{}'", cases.campaign.name, observable.name), "",
            refused->sentence.starts_with("no response model") ? refused->sentence
                                                               : "no response model: " + refused->sentence);
    }
    return std::get<ObservableModel>(std::move(learned));
}

}  // namespace grainsweep::study
