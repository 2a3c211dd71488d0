// What a response model predicts at settings, and how likely a case there has an answer.
#pragma once

#include "stats/response_model.hpp"
#include "sweep/study/answers.hpp"
#include "sweep/study/response_models.hpp"

#include <string>
#include <vector>

namespace grainsweep::study {

/// What a model predicts at settings.
struct Predicted {
    std::vector<Setting> settings;
    std::vector<stats::Prediction> predictions;  ///< NaN where an answer is less likely than none, unless extrapolated
    std::vector<double> defined;                 ///< probability that the observable is defined
    std::vector<double> answers;                 ///< probability that a case has an answer
    std::vector<Near> near;
};
/// Throws WrongQuestion where a feature has no number.
[[nodiscard]] Predicted predict(const ModelCases& cases, const ObservableModel& model, std::vector<Setting> settings,
                                bool extrapolate);

/// "no case near x = 0.05 has an answer, with probability 0.99: 5 of the 5 nearest cases failed (5 crashed)", and how
/// many such settings there are; empty: none.
[[nodiscard]] std::string failures_near(const ModelCases& cases, const Predicted& predicted);

}  // namespace grainsweep::study
