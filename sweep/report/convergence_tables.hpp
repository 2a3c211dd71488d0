// What `converge` shows of one campaign: rows for people, rows and JSON for programs.
#pragma once

#include "sweep/report/document.hpp"
#include "sweep/study/estimators.hpp"
#include "sweep/study/history.hpp"

#include <span>
#include <string>

namespace grainsweep::report {

/// One row per check in the columns of the view convergence_history and `provisional` (0), the last row over all
/// settled points.
[[nodiscard]] store::Table checks_rows(const study::Responses& responses, const study::ResponseColumn& response,
                                       const study::History& history);
/// The same columns of the provisional figures, `provisional` 1: one row, or none.
[[nodiscard]] store::Table provisional_rows(const study::Responses& responses, const study::ResponseColumn& response,
                                            const study::History& history);
/// All results of `converge` for one campaign as one value.
[[nodiscard]] Json to_json(const study::Responses& responses, const study::ResponseColumn& response,
                           const study::History& history, std::span<const study::LatticeStep> lattices);

/// One row per statistic that both give: plain, with the model, without scatter (where it is known). What is withdrawn
/// is marked.
[[nodiscard]] store::Table estimators_table(const study::History& history, const study::Estimators& estimators);
/// What the model rests on, and what must be said of it, in a sentence each.
[[nodiscard]] std::vector<std::string> estimator_lines(const study::Estimators& estimators);
/// {"plain": {"mean": {"value", "error"}, ...}, "model_assisted": {..., "taken", "withdrawn"} or null,
/// "without_scatter": {..., "withdrawn"} or null, "model_error", "scatter_from", "scatter_share": {"variance",
/// "third_moment", "fourth_moment"}, "note", "population"}
[[nodiscard]] Json estimators_json(const study::History& history, const study::Estimators& estimators);

/// What `converge` shows of a campaign, with no more computed than `format` takes.
[[nodiscard]] Document convergence_document(const store::Store& store, const study::Responses& responses,
                                            const study::ResponseColumn& response, Format format);

}  // namespace grainsweep::report
