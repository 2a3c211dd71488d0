#include "sweep/study/predicted.hpp"

#include "sweep/campaign/input_error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace grainsweep::study {
namespace {

/// A prediction rests on numbers: of a feature that has none there is no sense in one.
void refuse_undefined(const ModelCases& cases, const ObservableModel& model, std::span<const Setting> settings) {
    for (const auto& setting : settings) {
        const auto row = model.features.of(setting);
        const auto bad = std::ranges::find_if_not(row, [](double x) { return std::isfinite(x); });
        if (bad != row.end())
            throw campaign::input_error("", setting_text(cases.factors, setting),
                                        fmt::format("the feature '{}' of the model has no number there",
                                                    model.features.names[static_cast<std::size_t>(bad - row.begin())]));
    }
}

}  // namespace

Predicted predict(const ModelCases& cases, const ObservableModel& model, std::vector<Setting> settings,
                  bool extrapolate) {
    refuse_undefined(cases, model, settings);
    Predicted predicted{std::move(settings), {}, {}, {}, {}, {}, {}};
    predicted.predictions = model.predict(predicted.settings);
    predicted.defined = model.defined(predicted.settings);
    const Answers answers(cases);
    for (const auto& one : answers.at(predicted.settings)) {
        predicted.answers.push_back(one.probability);
        predicted.answers_low.push_back(one.low);
        predicted.answers_high.push_back(one.high);
    }
    for (std::size_t i = 0; i < predicted.settings.size(); ++i) {
        predicted.near.push_back(answers.near(predicted.settings[i]));
        constexpr double none = std::numeric_limits<double>::quiet_NaN();
        if (predicted.answers[i] < 0.5 && !extrapolate)
            predicted.predictions[i] = {.mean = none, .mean_error = none, .scatter = none};
    }
    return predicted;
}

std::string failures_near(const ModelCases& cases, const Predicted& predicted) {
    const auto unlikely = [](double answers) { return answers < 0.5; };
    const auto first = std::ranges::find_if(predicted.answers, unlikely);
    if (first == predicted.answers.end()) return {};
    const auto place = static_cast<std::size_t>(first - predicted.answers.begin());
    const auto n = std::ranges::count_if(predicted.answers, unlikely);
    std::string text = fmt::format("no case near {} has an answer, with probability {:.3f}: {}\n",
                                   setting_text(cases.factors, predicted.settings[place]), 1 - *first,
                                   near_text(cases, predicted.near[place]));
    if (n > 1)
        text += fmt::format("at {} of {} settings a case is likelier to fail than not\n", n, predicted.answers.size());
    return text;
}

}  // namespace grainsweep::study
