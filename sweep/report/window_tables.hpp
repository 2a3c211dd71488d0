// Process window as text, rows and JSON.
#pragma once

#include "sweep/report/document.hpp"
#include "sweep/study/process_window.hpp"

namespace grainsweep::report {

/// Returns the document. Text: share of the box, best setting, front, next cases, models and notes. Rows, one per
/// setting: part ("best", "surest", "front", "next"), factors, probability; if cases failed, also answers, near_cases
/// and near_failed; for each model NAME, NAME_error, NAME_scatter.
[[nodiscard]] Document window_document(const study::ModelCases& cases, const study::WindowRequest& request,
                                       const study::Window& window);
/// Returns the objectives in words: "largest mfr".
[[nodiscard]] std::string goal_text(const study::WindowRequest& request);
/// Returns the hypervolume with its error, and what the best front may dominate beyond it.
[[nodiscard]] std::string volume_text(const study::FrontVolume& volume);
/// {"campaign", "where", "objective", "objectives": [{"observable" or "factor", "maximize", "reference"}], "risk",
/// "judged", "share_of_box", "share_error", "share_low", "share_high", "share_failed", "best":
/// {"inputs", "mean", "mean_error", "scatter", "probability", "answers", "answers_low", "answers_high", "near_cases",
/// "near_failed", "observables"}, "surest", "computed_front": [{"inputs", "runs", "observables"; of two objectives
/// "means", "probability"}], "front", "hypervolume": {"value", "error", "further"}, "batches": [{"campaign", "cases",
/// "best" or "hypervolume", "hypervolume_error"}], "next", "models", "notes"}. mean, mean_error and scatter: of the
/// first objective.
[[nodiscard]] Json window_json(const study::ModelCases& cases, const study::WindowRequest& request,
                               const study::Window& window);

}  // namespace grainsweep::report
