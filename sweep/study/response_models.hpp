// Models of a campaign's responses as functions of its factors, fitted to its cases. Features: features.hpp; method and
// errors: stats/response_model.hpp.
//
// A model uses every answered case of the campaign, and of other campaigns of the database with the same scene, factors
// and fixed values. Each replicate is a case. A case without a number for the observable (NULL: undefined) is left out
// and counted. A separate model gives the probability that the observable is defined (stats/probability_model.hpp). An
// observable whose values are only 0 and 1, like `jammed`, also has a probability model: its mean is the probability of
// a 1.
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
    std::vector<std::string> notes;                      ///< to be read before its numbers are quoted
    std::vector<double> case_features;                   ///< features of all answered cases, row after row
    std::optional<stats::ProbabilityModel> has_a_value;  ///< empty: the observable is defined in every case

    [[nodiscard]] std::vector<stats::Prediction> predict(std::span<const Setting> settings) const;
    /// Returns only the means at rows of features, which is faster.
    [[nodiscard]] std::vector<double> means(std::span<const double> rows) const;
    /// Returns the probability that the observable is defined.
    [[nodiscard]] std::vector<double> defined(std::span<const Setting> settings) const;
    /// Returns the features of the settings, row after row.
    [[nodiscard]] std::vector<double> rows(std::span<const Setting> settings) const;
    /// Returns the model with a case added; its response may be assumed instead of computed.
    [[nodiscard]] ObservableModel with_case(const Setting& setting, double response) const;
    [[nodiscard]] std::size_t cases() const;
    [[nodiscard]] bool is_probability() const { return std::holds_alternative<stats::ProbabilityModel>(model); }
    /// Returns the degrees of freedom of its predictions, the same at every setting.
    [[nodiscard]] double freedom() const;
    /// Returns residuals of left-out cases over their errors; none of a probability.
    [[nodiscard]] std::vector<double> scores() const;
};

/// Treatment of a response that the factors hardly explain.
enum class Unexplained {
    refused,
    scatter  ///< the model counts it as scatter of single runs, with a note
};

/// Fits a model of one observable. Throws InputError if a written feature cannot be evaluated.
[[nodiscard]] std::variant<ObservableModel, stats::Refusal> learn(const ModelCases& cases,
                                                                  const ResponseColumn& observable,
                                                                  Unexplained unexplained = Unexplained::refused);
/// Fits a model of one observable. Throws InputError with the reason if the model is refused.
[[nodiscard]] ObservableModel learn_or_refuse(const ModelCases& cases, const ResponseColumn& observable,
                                              Unexplained unexplained = Unexplained::refused);

}  // namespace grainsweep::study
