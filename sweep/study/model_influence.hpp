// Which factors move the mean response, alone and together, by a response model of the campaign's settled cases: total
// indices and interactions from any design (stats/model_indices.hpp), beside the indices from the cases themselves.
//
// Refused where the model is (stats/response_model.hpp), and where the campaign's `where` leaves a part of the box out:
// indices are over all of it, and there are no cases in that part. Errors come from leaving out independent sequences,
// or eight stretches of the cases.
#pragma once

#include "stats/model_indices.hpp"
#include "sweep/study/response_models.hpp"
#include "sweep/study/responses.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace grainsweep::study {

struct ModelInfluence {
    std::vector<std::string> factors;            ///< that vary, in the campaign's order
    std::optional<stats::ModelIndices> indices;  ///< none: refused
    std::optional<ObservableModel> model;
    std::size_t without_value = 0;     ///< settled cases
    std::vector<std::string> noise;    ///< names of the noise factors that vary; empty: no share is made of them
    std::vector<std::string> calmest;  ///< parts of the ranges of indices->noise->controls: "between 0.005 and 0.006"
    std::string refused;               ///< why: one sentence without a full stop
};

/// Throws WrongQuestion where a feature of the campaign file cannot be evaluated.
[[nodiscard]] ModelInfluence model_influence_of(const Responses& responses, const ResponseColumn& response);
/// The same by a model that was learned of settled_cases(responses).
[[nodiscard]] ModelInfluence model_influence_of(const Responses& responses, const ResponseColumn& response,
                                                const ObservableModel& model);

}  // namespace grainsweep::study
