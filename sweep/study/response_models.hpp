// Responses of a campaign as functions of its factors, learned from its cases: features.hpp says of what,
// stats/response_model.hpp how, and with which errors.
//
// A model rests on every answered case of the campaign, and on those of further campaigns of the database that ask the
// same scene with the same factors and fixed values, wherever their points stand. Replicates are cases of their own.
// A case without a number for the observable (NULL: undefined there) is left out of the model and counted. The
// probability that a setting has one is a model of its own (stats/probability_model.hpp). So is an observable whose
// values are 0 and 1 alone, like `jammed`: its mean is the probability of a 1.
#pragma once

#include "stats/probability_model.hpp"
#include "stats/response_model.hpp"
#include "sweep/study/model_cases.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace grainsweep::study {

struct ObservableModel {
    std::string observable, unit;
    Features features;
    std::variant<stats::ResponseModel, stats::ProbabilityModel> model;
    std::size_t undefined = 0;                           ///< answered cases without a number
    std::vector<std::string> notes;                      ///< what a reader must know before quoting its figures
    std::vector<double> case_features;                   ///< of all answered cases, row after row
    std::optional<stats::ProbabilityModel> has_a_value;  ///< none: every case is defined

    [[nodiscard]] std::vector<stats::Prediction> predict(std::span<const Setting> settings) const;
    /// Means only, which is faster; of rows of features.
    [[nodiscard]] std::vector<double> means(std::span<const double> rows) const;
    /// Probability that the observable is defined.
    [[nodiscard]] std::vector<double> defined(std::span<const Setting> settings) const;
    /// Features of the settings, row after row.
    [[nodiscard]] std::vector<double> rows(std::span<const Setting> settings) const;
    /// The model with the response of a setting added, which may be a fantasy.
    [[nodiscard]] ObservableModel with_case(const Setting& setting, double response) const;
    [[nodiscard]] std::size_t cases() const;
    [[nodiscard]] bool is_probability() const { return std::holds_alternative<stats::ProbabilityModel>(model); }
    /// Of its predictions, the same at every setting.
    [[nodiscard]] double freedom() const;
};

/// What becomes of a response that the factors hardly explain.
enum class Unexplained {
    refused,
    scatter  ///< the model counts it as scatter of single runs, with a note
};

/// Learns one observable. Throws WrongQuestion where a written feature cannot be evaluated.
[[nodiscard]] std::variant<ObservableModel, stats::Refusal> learn(const ModelCases& cases,
                                                                  const ResponseColumn& observable,
                                                                  Unexplained unexplained = Unexplained::refused);
/// The same; throws WrongQuestion with the sentence of the refusal.
[[nodiscard]] ObservableModel learn_or_refuse(const ModelCases& cases, const ResponseColumn& observable,
                                              Unexplained unexplained = Unexplained::refused);

}  // namespace grainsweep::study
