// What `sensitivity` shows of one campaign: rows for people, rows and JSON for programs.
#pragma once

#include "sweep/store/store.hpp"
#include "sweep/study/influence.hpp"
#include "sweep/study/model_influence.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace grainsweep::report {

/// One row per factor for people, the most influential first.
[[nodiscard]] store::Table influence_table(const study::Influence& influence);
/// One row per factor for programs, in the campaign's order; what the method does not give is absent.
[[nodiscard]] store::Table influence_rows(const study::Responses& responses, const study::ResponseColumn& response,
                                          const study::Influence& influence);
[[nodiscard]] nlohmann::ordered_json to_json(const study::Responses& responses, const study::ResponseColumn& response,
                                             const study::Influence& influence);

/// One row per factor, the most influential first: first order, total, interactions.
[[nodiscard]] store::Table model_influence_table(const study::ModelInfluence& influence);
/// Pairs of factors whose interaction is larger than its error, and what the model rests on, a sentence each.
[[nodiscard]] std::vector<std::string> model_influence_lines(const study::ModelInfluence& influence);
/// {"factors": [{"name", "first", "total", "interactions"}], "pairs": [{"factors", "value", "error"}], "scatter_share",
/// "unexplained_share", "response_model", "refused"}; indices {"value", "error"}, shares of the variance of single runs
[[nodiscard]] nlohmann::ordered_json model_influence_json(const study::ModelInfluence& influence);

}  // namespace grainsweep::report
