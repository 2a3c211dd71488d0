// Response models and what they predict, as text, tables and JSON.
#pragma once

#include "sweep/store/store.hpp"
#include "sweep/study/predicted.hpp"

#include <nlohmann/json_fwd.hpp>

#include <span>
#include <string>
#include <vector>

namespace grainsweep::report {

/// What a model rests on and how far its errors can be believed, in a few lines; then its notes, "note: " each.
[[nodiscard]] std::string model_lines(const study::ObservableModel& model);
/// {"observable", "cases", "rests_on", "undefined", "leave_one_out_error", "coverage_50", "coverage_95", "noise_share",
/// "features", "learned_map", "notes"}
[[nodiscard]] nlohmann::ordered_json model_json(const study::ObservableModel& model);

/// {"gap": 0.003, "cohesion_law": "sjkr"}
[[nodiscard]] nlohmann::ordered_json inputs_json(std::span<const study::ModelFactor> factors,
                                                 const study::Setting& setting);
[[nodiscard]] std::vector<store::Table::Cell> input_cells(std::span<const study::ModelFactor> factors,
                                                          const study::Setting& setting);

/// One row per setting: factors, mean, mean_error, scatter, inside (1 or 0), where the observable can be undefined the
/// probability that it is not, and where cases failed answers_near (1 or 0), near_cases and near_failed.
[[nodiscard]] store::Table predictions_table(const study::ModelCases& cases, const study::ObservableModel& model,
                                             const study::Predicted& predicted);
/// {"campaign", "observable", "points": [...], "model": {...}}
[[nodiscard]] nlohmann::ordered_json predictions_json(const study::ModelCases& cases,
                                                      const study::ObservableModel& model,
                                                      const study::Predicted& predicted);

/// As a page's program reads them: [{"name", "unit", "levels": texts, "numbers", "low", "high", "log"}, ...]
[[nodiscard]] nlohmann::ordered_json axes_json(std::span<const study::ModelFactor> factors);
/// [{"setting": [...], "outcome": "crashed"}, ...], to be drawn: at most 2,000, chosen at random, the same every time.
[[nodiscard]] nlohmann::ordered_json failed_json(const study::ModelCases& cases);

}  // namespace grainsweep::report
