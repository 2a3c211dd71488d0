// The cases of a campaign that models are learned from: settings, observables, and where cases failed.
#pragma once

#include "sweep/store/store.hpp"
#include "sweep/study/features.hpp"
#include "sweep/study/responses.hpp"

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
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
    /// Whether the scene accepts a setting, known without running it; empty: no case was rejected for its setting.
    std::function<bool(const Setting&)> possible;

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

/// Whether the campaign's `where` clause lets a setting pass, and its shares add to one; empty where it has neither, or
/// no case is answered.
[[nodiscard]] std::function<bool(const Setting&)> admission(const store::Store& store, const ModelCases& cases);

/// "friction = 0.1, gap = 0.003"
[[nodiscard]] std::string setting_text(std::span<const ModelFactor> factors, const Setting& setting);
/// "gap = 0.006 is above 0.001 to 0.005" for every factor outside of its range; empty: inside the box.
[[nodiscard]] std::string outside_text(std::span<const ModelFactor> factors, const Setting& setting);

}  // namespace grainsweep::study
