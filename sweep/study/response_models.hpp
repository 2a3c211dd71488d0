// Responses of a campaign as functions of its factors, learned from its cases: features.hpp says of what,
// stats/response_model.hpp how, and with which errors.
//
// A model rests on every answered case of the campaign, and on those of further campaigns of the database that ask the
// same scene with the same factors and fixed values, wherever their points stand. Replicates are cases of their own.
// A case without a number for the observable (NULL: undefined there) is left out of the model and counted. How likely a
// setting is to have one comes from a second response model, of the signed distance to the boundary between cases that
// have one and cases that have none:
//
//   b_i = +- distance of case i to the nearest case of the other kind, features scaled to their box; + where defined
//   P(defined at x) = Phi(mean/sqrt(mean_error^2 + scatter^2)) of the model of b at x
//
// Where that model is refused (a handful of undefined cases, say) it is the share of the k = max(8, sqrt(n)/1.5)
// nearest cases that are defined, with one more case that is so with the share of all cases.
#pragma once

#include "stats/response_model.hpp"
#include "sweep/store/store.hpp"
#include "sweep/study/features.hpp"
#include "sweep/study/responses.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace grainsweep::study {

/// A case with a final outcome and without an answer.
struct FailedCase {
    Setting setting;
    campaign::Outcome outcome = campaign::Outcome::crashed;
};

/// What the models of a campaign are learned from.
struct ModelCases {
    store::CampaignRecord campaign;
    std::vector<std::string> further;  ///< campaigns whose cases are there, too
    std::vector<ModelFactor> factors;
    std::vector<std::string> features;        ///< as the campaign file has them; empty: by default
    std::vector<Setting> settings;            ///< of the answered cases
    std::vector<ResponseColumn> observables;  ///< one value per setting
    std::string main;                         ///< name of the main observable; empty: none has a value
    std::string case_id;                      ///< of an answered case: it has the fixed values
    std::vector<FailedCase> failed;

    /// Throws WrongQuestion with the nearest name. Empty: the main observable.
    [[nodiscard]] const ResponseColumn& observable(std::string_view name) const;
    [[nodiscard]] std::vector<std::string> observable_names() const;
    [[nodiscard]] std::vector<std::string> factor_names() const;
};

/// The campaign of that name. Empty: the only one there is, or those that ask the same with different points; throws
/// WrongQuestion where that leaves a choice.
[[nodiscard]] ModelCases read_model_cases(const store::Store& store, std::string_view campaign);

/// The answered cases of a campaign's settled beginning alone, which its statistics are over. `rows`: where each case
/// stands in `responses`.
[[nodiscard]] ModelCases settled_cases(const Responses& responses, std::vector<std::size_t>* rows = nullptr);

struct ObservableModel {
    std::string observable, unit;
    Features features;
    stats::ResponseModel model;
    std::size_t undefined = 0;       ///< answered cases without a number
    std::vector<std::string> notes;  ///< what a reader must know before quoting its figures

    [[nodiscard]] std::vector<stats::Prediction> predict(std::span<const Setting> settings) const;
    /// Probability that the observable is defined, see above.
    [[nodiscard]] std::vector<double> defined(std::span<const Setting> settings) const;
    /// Features of the settings, row after row.
    [[nodiscard]] std::vector<double> rows(std::span<const Setting> settings) const;

    std::vector<double> case_features;  ///< of all answered cases, row after row
    std::vector<bool> case_defined;
    std::optional<stats::ResponseModel> boundary;  ///< of b; none: every case is defined, or it was refused
};

/// Learns one observable. Throws WrongQuestion where a written feature cannot be evaluated.
[[nodiscard]] std::variant<ObservableModel, stats::Refusal> learn(const ModelCases& cases,
                                                                  const ResponseColumn& observable);
/// The same; throws WrongQuestion with the sentence of the refusal.
[[nodiscard]] ObservableModel learn_or_refuse(const ModelCases& cases, const ResponseColumn& observable);

/// Whether the campaign's `where` clause lets a setting pass; empty where it has none or no case is answered.
[[nodiscard]] std::function<bool(const Setting&)> admission(const store::Store& store, const ModelCases& cases);

/// "friction = 0.1, gap = 0.003"
[[nodiscard]] std::string setting_text(std::span<const ModelFactor> factors, const Setting& setting);
/// "gap = 0.006 is above 0.001 to 0.005" for every factor outside of its range; empty: inside the box.
[[nodiscard]] std::string outside_text(std::span<const ModelFactor> factors, const Setting& setting);

}  // namespace grainsweep::study
