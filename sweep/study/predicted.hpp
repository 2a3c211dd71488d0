// Predictions of a response model at settings, with the probability that a case there has an answer.
#pragma once

#include "stats/response_model.hpp"
#include "sweep/study/answers.hpp"
#include "sweep/study/response_models.hpp"

#include <string>
#include <vector>

namespace grainsweep::study {

/// Predictions of a model at settings.
struct Predicted {
    std::vector<Setting> settings;
    std::vector<stats::Prediction> predictions;  ///< NaN where an answer is less likely than none, unless extrapolated
    std::vector<double> defined;                 ///< probability that the observable is defined
    std::vector<double> answers;                 ///< probability that a case has an answer
    std::vector<double> answers_low, answers_high;  ///< ends of its 95 % interval
    std::vector<Near> near;
};
/// Returns the predictions. Throws InputError if a feature is undefined at a setting.
[[nodiscard]] Predicted predict(const ModelCases& cases, const ObservableModel& model, std::vector<Setting> settings,
                                bool extrapolate);

/// Returns a text such as "no case near x = 0.05 has an answer, with probability 0.99: 5 of the 5 nearest cases failed
/// (5 crashed)", with the number of such settings; empty: there is none.
[[nodiscard]] std::string failures_near(const ModelCases& cases, const Predicted& predicted);

}  // namespace grainsweep::study
