// Which factors move the mean response, alone and together, by a response model of the campaign's settled cases: total
// indices and interactions from any design (stats/model_indices.hpp), beside those that come from the cases directly.
//
// Refused where the model is (stats/response_model.hpp), and where the campaign's `where` leaves a part of the box out:
// indices are over all of it, and there are no cases in that part. Errors come from leaving out independent sequences,
// or eight stretches of the cases.
#pragma once

#include "stats/model_indices.hpp"
#include "sweep/report/response_models.hpp"
#include "sweep/report/responses.hpp"
#include "sweep/store/store.hpp"

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace grainsweep::report {

struct ModelInfluence {
    std::vector<std::string> factors;            ///< that vary, in the campaign's order
    std::optional<stats::ModelIndices> indices;  ///< none: refused
    std::optional<ObservableModel> model;
    std::size_t without_value = 0;  ///< settled cases
    std::string refused;            ///< why: one sentence without a full stop
};

/// Throws WrongQuestion where a feature of the campaign file cannot be evaluated.
[[nodiscard]] ModelInfluence model_influence_of(const Responses& responses, const ResponseColumn& response);

/// One row per factor, the most influential first: first order, total, interactions.
[[nodiscard]] store::Table model_influence_table(const ModelInfluence& influence);
/// Pairs of factors whose interaction is larger than its error, and what the model rests on, a sentence each.
[[nodiscard]] std::vector<std::string> model_influence_lines(const ModelInfluence& influence);
/// {"factors": [{"name", "first", "total", "interactions"}], "pairs": [{"factors", "value", "error"}], "scatter_share",
/// "unexplained_share", "response_model", "refused"}; indices {"value", "error"}, shares of the variance of single runs
[[nodiscard]] nlohmann::ordered_json model_influence_json(const ModelInfluence& influence);

}  // namespace grainsweep::report
