// Cases from which a campaign's models are fitted: settings, observables, and failures.
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

/// Case with a final outcome and without an answer.
struct FailedCase {
    Setting setting;
    campaign::Outcome outcome = campaign::Outcome::crashed;
};

/// Cases from which the models of a campaign are fitted.
struct ModelCases {
    store::CampaignRecord campaign;
    std::vector<std::string> further;  ///< names of other campaigns whose cases are included
    std::vector<ModelFactor> factors;
    std::vector<std::string> features;        ///< from the campaign file; empty: by default
    std::vector<Setting> settings;            ///< of the answered cases
    std::vector<std::size_t> sources;         ///< of each setting: 0 this campaign, k the k-th of `further`
    std::vector<ResponseColumn> observables;  ///< one value per setting
    std::string main;                         ///< name of the main observable; empty: no observable has a value
    std::string case_id;                      ///< id of an answered case, which has the fixed values
    std::vector<FailedCase> failed;
    std::vector<campaign::Outcome> left_out;  ///< outcomes whose failures are no property of the process
    std::size_t cases_left_out = 0;           ///< failed cases with these outcomes, which are not in `failed`
    /// Check of the scene whether a setting is possible, without running it; empty: no case was rejected for its
    /// setting.
    std::function<bool(const Setting&)> possible;

    /// Returns the observable of this name; empty name: the main observable. Throws InputError with the nearest
    /// name.
    [[nodiscard]] const ResponseColumn& observable(std::string_view name) const;
    [[nodiscard]] std::vector<std::string> observable_names() const;
    [[nodiscard]] std::vector<std::string> factor_names() const;
};

/// Returns the cases of the named campaign. Empty name: of the only campaign, or of all campaigns that differ in their
/// points alone; throws InputError if more than one choice is left. `left_out`: outcomes of failed cases that are
/// not used.
[[nodiscard]] ModelCases read_model_cases(const store::Store& store, std::string_view campaign,
                                          std::span<const campaign::Outcome> left_out = {});

/// Returns only the answered cases of a campaign's settled prefix, from which its statistics are computed. `rows`: the
/// row of each case in `responses`.
[[nodiscard]] ModelCases settled_cases(const Responses& responses, std::vector<std::size_t>* rows = nullptr);

/// Returns these cases, and the imported ones that the design does not place. Models are fitted from them.
[[nodiscard]] ModelCases settled_and_imported_cases(const Responses& responses);

/// Returns a filter: whether the campaign's `where` clause accepts a setting and its shares add to one. Empty if the
/// campaign has neither, or no case is answered.
[[nodiscard]] std::function<bool(const Setting&)> admission(const store::Store& store, const ModelCases& cases);

/// Returns a text such as "friction = 0.1, gap = 0.003".
[[nodiscard]] std::string setting_text(std::span<const ModelFactor> factors, const Setting& setting);
/// Returns a text such as "gap = 0.006 is above 0.001 to 0.005" for every factor outside its range; empty: inside the
/// box.
[[nodiscard]] std::string outside_text(std::span<const ModelFactor> factors, const Setting& setting);
/// Returns a sentence on the first number of the settings that is no level of its factor; empty: there is none.
[[nodiscard]] std::string between_levels_text(std::span<const ModelFactor> factors, std::span<const Setting> settings);

}  // namespace grainsweep::study
