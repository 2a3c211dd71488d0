// A process window as text, rows and JSON.
#pragma once

#include "sweep/store/store.hpp"
#include "sweep/study/process_window.hpp"

#include <nlohmann/json_fwd.hpp>

#include <iosfwd>

namespace grainsweep::report {

/// Share of the box, best setting, front, next cases, models and notes.
void write_window(std::ostream& out, const study::ModelCases& cases, const study::WindowRequest& request,
                  const study::Window& window);
/// {"campaign", "where", "objective", "risk", "judged", "share_of_box", "share_error", "share_failed", "best":
/// {"inputs", "mean", "mean_error", "scatter", "probability", "near_cases", "near_failed", "observables"}, "surest",
/// "front", "next", "models", "notes"}
[[nodiscard]] nlohmann::ordered_json window_json(const study::ModelCases& cases, const study::WindowRequest& request,
                                                 const study::Window& window);
/// One row per setting: part ("best", "surest", "front", "next"), factors, probability, where cases failed near_cases
/// and near_failed, and for each model NAME, NAME_error, NAME_scatter.
[[nodiscard]] store::Table window_rows(const study::ModelCases& cases, const study::Window& window);

}  // namespace grainsweep::report
