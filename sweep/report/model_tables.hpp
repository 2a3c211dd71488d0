// Response models and what they predict, as text, tables and JSON.
#pragma once

#include "sweep/report/document.hpp"
#include "sweep/store/store.hpp"
#include "sweep/study/predicted.hpp"

#include <span>
#include <string>
#include <vector>

namespace grainsweep::report {

/// What a model rests on and how far its errors can be believed, in a few lines; then its notes, "note: " each.
[[nodiscard]] std::string model_lines(const study::ObservableModel& model);
/// {"observable", "kind": "response" or "probability", "cases", "rests_on", "undefined", "features", "notes"}; of a
/// response "leave_one_out_error", "coverage_50", "coverage_95", "noise_share", "learned_map", of a probability "ones",
/// "brier", "brier_of_share".
[[nodiscard]] Json model_json(const study::ObservableModel& model);

/// {"gap": 0.003, "cohesion_law": "sjkr"}; null: averaged over.
[[nodiscard]] Json inputs_json(std::span<const study::ModelFactor> factors, const study::Setting& setting);
[[nodiscard]] std::vector<store::Table::Cell> input_cells(std::span<const study::ModelFactor> factors,
                                                          const study::Setting& setting);

/// One row per setting: factors, mean, mean_error, scatter, inside (1 or 0), of a probability mean_low and mean_high,
/// where the observable can be undefined the probability that it is not, and where cases failed answers (the
/// probability of an answer), near_cases and near_failed.
[[nodiscard]] store::Table predictions_table(const study::ModelCases& cases, const study::ObservableModel& model,
                                             const study::Predicted& predicted);
/// What `predict` shows.
[[nodiscard]] Document predictions_document(const study::ModelCases& cases, const study::ObservableModel& model,
                                            const study::Predicted& predicted);
/// {"campaign", "observable", "points": [...], "model": {...}}
[[nodiscard]] Json predictions_json(const study::ModelCases& cases, const study::ObservableModel& model,
                                    const study::Predicted& predicted);

/// As a page's program reads them: [{"name", "unit", "levels": texts, "numbers", "low", "high", "log"}, ...]
[[nodiscard]] Json axes_json(std::span<const study::ModelFactor> factors);
/// Of a map over factors a and b: {"across", "up", "across_edges", "up_edges", "columns", "rows"}
[[nodiscard]] Json map_json(std::span<const study::ModelFactor> factors, std::size_t a, std::size_t b,
                            std::size_t count);
/// [{"setting": [...], "outcome": "crashed"}, ...], to be drawn: at most 2,000, chosen at random, the same every time.
[[nodiscard]] Json failed_json(const study::ModelCases& cases);

}  // namespace grainsweep::report
