// What `converge` shows of one campaign: rows for people, rows and JSON for programs.
#pragma once

#include "sweep/study/estimators.hpp"
#include "sweep/study/history.hpp"

#include <nlohmann/json_fwd.hpp>

#include <span>
#include <string>

namespace grainsweep::report {

/// The five statistics of all settled points: value, 95 % error, what the rule compares with the tolerance, and
/// whether it is a gate that holds the campaign back.
[[nodiscard]] store::Table statistics_table(const study::History& history);
/// The same of every finished case, not judged; empty where there is nothing provisional.
[[nodiscard]] store::Table provisional_table(const study::History& history);
/// One row per check for people, some 20 of them where there are more: every statistic with its error.
[[nodiscard]] store::Table checks_table(const study::History& history);
/// One row per check in the columns of the view convergence_history and `provisional` (0), the last row over all
/// settled points.
[[nodiscard]] store::Table checks_rows(const study::Responses& responses, const study::ResponseColumn& response,
                                       const study::History& history);
/// The same columns of the provisional figures, `provisional` 1: one row, or none.
[[nodiscard]] store::Table provisional_rows(const study::Responses& responses, const study::ResponseColumn& response,
                                            const study::History& history);
/// Lattices of one family: moments and how far they moved since the coarser one, as a share of what a rule compares.
[[nodiscard]] store::Table lattice_table(std::span<const study::LatticeStep> steps);
/// The same for people: "2.679 (30 %)".
[[nodiscard]] store::Table lattice_lines(std::span<const study::LatticeStep> steps);
/// Everything `converge` knows of one campaign as one value.
[[nodiscard]] nlohmann::ordered_json to_json(const study::Responses& responses, const study::ResponseColumn& response,
                                             const study::History& history,
                                             std::span<const study::LatticeStep> lattices);

/// One row per statistic that both give: plain, with the model, without scatter (where it is known). What is withdrawn
/// is marked.
[[nodiscard]] store::Table estimators_table(const study::Estimators& estimators);
/// What the model rests on, and what must be said of it, in a sentence each.
[[nodiscard]] std::vector<std::string> estimator_lines(const study::Estimators& estimators);
/// {"plain": {"mean": {"value", "error"}, ...}, "model_assisted": {..., "taken", "withdrawn"} or null,
/// "without_scatter": {..., "withdrawn"} or null, "model_error", "scatter_from", "scatter_share": {"variance",
/// "third_moment", "fourth_moment"}, "note", "population"}
[[nodiscard]] nlohmann::ordered_json estimators_json(const study::History& history,
                                                     const study::Estimators& estimators);

}  // namespace grainsweep::report
