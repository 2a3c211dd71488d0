// Process window as text, rows and JSON.
#pragma once

#include "sweep/report/document.hpp"
#include "sweep/report/result.hpp"
#include "sweep/report/results/models.hpp"
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
/// mean, mean_error and scatter of a setting: of the first objective.
[[nodiscard]] Result<results::window> window_json(const study::ModelCases& cases, const study::WindowRequest& request,
                                                  const study::Window& window);

}  // namespace grainsweep::report
