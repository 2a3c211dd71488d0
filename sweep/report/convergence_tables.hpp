// Output of `converge` for one campaign: tables for people, rows and JSON for programs.
#pragma once

#include "sweep/report/document.hpp"
#include "sweep/report/result.hpp"
#include "sweep/report/results/study.hpp"
#include "sweep/study/estimators.hpp"
#include "sweep/study/history.hpp"

#include <span>
#include <string>

namespace grainsweep::report {

/// Returns one row per check, with the columns of the view convergence_history and `provisional` (0); the last row is
/// for all settled points.
[[nodiscard]] store::Table checks_rows(const study::Responses& responses, const study::ResponseColumn& response,
                                       const study::History& history);
/// Returns the same columns of the provisional moments, `provisional` 1: one row, or none.
[[nodiscard]] store::Table provisional_rows(const study::Responses& responses, const study::ResponseColumn& response,
                                            const study::History& history);
/// Returns all results of `converge` for one campaign as one JSON value.
[[nodiscard]] Result<results::converge> to_json(const study::Responses& responses,
                                                const study::ResponseColumn& response, const study::History& history,
                                                std::span<const study::LatticeStep> lattices);

/// Returns one row per statistic of both estimators: plain, with the model, without scatter (if it is known). Withdrawn
/// values are marked.
[[nodiscard]] store::Table estimators_table(const study::History& history, const study::Estimators& estimators);
/// Returns sentences on the cases of the model and its limits.
[[nodiscard]] std::vector<std::string> estimator_lines(const study::Estimators& estimators);
[[nodiscard]] Result<results::estimators> estimators_json(const study::History& history,
                                                          const study::Estimators& estimators);

/// Returns the output of `converge` for a campaign; computes only the parts that `format` needs. `levels`: beside those
/// among the gates; empty: study::shown_levels. `without`: what completed cases without a value count as in them; where
/// they count, no model estimates levels.
[[nodiscard]] Document convergence_document(const store::Store& store, const study::Responses& responses,
                                            const study::ResponseColumn& response, Format format,
                                            std::span<const stats::Level> levels = {},
                                            study::WithoutValue without = study::WithoutValue::left_out);

}  // namespace grainsweep::report
