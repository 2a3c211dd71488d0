// Output of `sensitivity` for one campaign: tables for people, rows and JSON for programs.
#pragma once

#include "sweep/report/document.hpp"
#include "sweep/report/result.hpp"
#include "sweep/report/results/study.hpp"
#include "sweep/study/influence.hpp"
#include "sweep/study/model_influence.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::report {

/// Returns "given_data", "saltelli" or "morris".
[[nodiscard]] std::string_view method_name(study::Influence::Method method);
/// Returns the columns of a page's table for this method: title, and the member of a factor with its text.
[[nodiscard]] Json shown_of(study::Influence::Method method);
/// Returns one row per factor for people, the most influential first.
[[nodiscard]] store::Table influence_table(const study::Influence& influence);
[[nodiscard]] Result<results::sensitivity> to_json(const study::Responses& responses,
                                                   const study::ResponseColumn& response,
                                                   const study::Influence& influence);

/// Returns one row per factor, the most influential first: first order, total, interactions.
[[nodiscard]] store::Table model_influence_table(const study::ModelInfluence& influence);
/// Returns sentences on pairs of factors whose interaction exceeds its error, and on the cases of the model.
[[nodiscard]] std::vector<std::string> model_influence_lines(const study::ModelInfluence& influence);
[[nodiscard]] Result<results::model_influence> model_influence_json(const study::ModelInfluence& influence);
/// Returns {"columns", "rows", "says": lines} of the table for people, for a page.
[[nodiscard]] Json model_influence_page(const study::ModelInfluence& influence);

/// Returns the output of `sensitivity` for a campaign; computes only the parts that `format` needs.
[[nodiscard]] Document influence_document(const study::Responses& responses, const study::ResponseColumn& response,
                                          Format format);

}  // namespace grainsweep::report
