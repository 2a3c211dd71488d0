// What `sensitivity` shows of one campaign: rows for people, rows and JSON for programs.
#pragma once

#include "sweep/report/document.hpp"
#include "sweep/study/influence.hpp"
#include "sweep/study/model_influence.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::report {

/// "given_data", "saltelli" or "morris".
[[nodiscard]] std::string_view method_name(study::Influence::Method method);
/// What a page shows of every factor by this method, and by what its bars are sorted.
[[nodiscard]] Json shown_of(study::Influence::Method method);
/// One row per factor for people, the most influential first.
[[nodiscard]] store::Table influence_table(const study::Influence& influence);
[[nodiscard]] Json to_json(const study::Responses& responses, const study::ResponseColumn& response,
                           const study::Influence& influence);

/// One row per factor, the most influential first: first order, total, interactions.
[[nodiscard]] store::Table model_influence_table(const study::ModelInfluence& influence);
/// Pairs of factors whose interaction is larger than its error, and what the model rests on, a sentence each.
[[nodiscard]] std::vector<std::string> model_influence_lines(const study::ModelInfluence& influence);
/// {"factors": [{"name", "first", "total", "interactions"}], "pairs": [{"factors", "value", "error"}], "scatter_share",
/// "unexplained_share", "response_model", "refused"}; indices {"value", "error"}, shares of the variance of single runs
[[nodiscard]] Json model_influence_json(const study::ModelInfluence& influence);
/// {"columns", "rows", "says": lines} of the table for people, as a page shows it.
[[nodiscard]] Json model_influence_page(const study::ModelInfluence& influence);

/// What `sensitivity` shows of a campaign, with no more computed than `format` takes.
[[nodiscard]] Document influence_document(const study::Responses& responses, const study::ResponseColumn& response,
                                          Format format);

}  // namespace grainsweep::report
