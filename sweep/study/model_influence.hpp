// Influence of factors on the mean response, alone and together, by a response model of the campaign's settled cases.
// It gives total indices and interactions from any design (stats/model_indices.hpp), beside the indices from the cases
// themselves.
//
// Refused if the model is refused (stats/response_model.hpp). Refused also if the campaign's `where` excludes a part of
// the box: the indices refer to the whole box, and that part has no cases. Errors come from leaving out independent
// sequences, or eight batches of the cases.
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
    std::vector<std::string> factors;            ///< varied factors, in the campaign's order
    std::optional<stats::ModelIndices> indices;  ///< empty: refused
    std::optional<ObservableModel> model;
    std::size_t without_value = 0;       ///< settled cases
    std::vector<std::string> noise;      ///< names of the varied noise factors; empty: there is no share of noise
    std::vector<std::string> calmest;    ///< for each of indices->noise->controls the part of its range, as text:
                                         ///< "between 0.005 and 0.006"
    std::vector<std::string> dependent;  ///< varied factors that are columns of one sample: they have Shapley effects
    std::string refused;                 ///< reason: one sentence without a full stop

    /// Returns whether factors depend on each other, so that Shapley effects replace the indices.
    [[nodiscard]] bool depends() const { return !dependent.empty(); }
};

/// Fits a model and returns its indices. Throws InputError if a feature of the campaign file cannot be evaluated.
[[nodiscard]] ModelInfluence model_influence_of(const Responses& responses, const ResponseColumn& response);
/// Returns the indices of a model fitted to settled_cases(responses).
[[nodiscard]] ModelInfluence model_influence_of(const Responses& responses, const ResponseColumn& response,
                                                const ObservableModel& model);

}  // namespace grainsweep::study
