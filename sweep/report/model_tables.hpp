// Response models and what they predict, as text, tables and JSON.
#pragma once

#include "stats/response_model.hpp"
#include "sweep/report/response_models.hpp"
#include "sweep/store/store.hpp"

#include <nlohmann/json_fwd.hpp>

#include <span>
#include <string>

namespace grainsweep::report {

/// What a model rests on and how far its errors can be believed, in a few lines; then its notes, "note: " each.
[[nodiscard]] std::string model_lines(const ObservableModel& model);
/// {"observable", "cases", "rests_on", "undefined", "leave_one_out_error", "coverage_50", "coverage_95", "noise_share",
/// "features", "learned_map", "notes"}
[[nodiscard]] nlohmann::ordered_json model_json(const ObservableModel& model);

/// {"gap": 0.003, "cohesion_law": "sjkr"}
[[nodiscard]] nlohmann::ordered_json inputs_json(std::span<const ModelFactor> factors, const Setting& setting);
[[nodiscard]] std::vector<store::Table::Cell> input_cells(std::span<const ModelFactor> factors, const Setting& setting);

/// One row per setting: factors, mean, mean_error, scatter, inside (1 or 0), and where the observable can be undefined
/// the probability that it is not.
[[nodiscard]] store::Table predictions_table(const ModelCases& cases, const ObservableModel& model,
                                             std::span<const Setting> settings);
/// {"campaign", "observable", "points": [...], "model": {...}}
[[nodiscard]] nlohmann::ordered_json predictions_json(const ModelCases& cases, const ObservableModel& model,
                                                      std::span<const Setting> settings);

}  // namespace grainsweep::report
