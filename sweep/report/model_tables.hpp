// Response models and their predictions as text, tables and JSON.
#pragma once

#include "sweep/report/document.hpp"
#include "sweep/report/result.hpp"
#include "sweep/report/results/models.hpp"
#include "sweep/store/store.hpp"
#include "sweep/study/predicted.hpp"

#include <span>
#include <string>
#include <vector>

namespace grainsweep::report {

/// Returns the cases of a model and the quality of its errors in a few lines; then its notes, each with "note: ".
[[nodiscard]] std::string model_lines(const study::ObservableModel& model);
[[nodiscard]] Result<results::model> model_json(const study::ObservableModel& model);

/// Returns an object such as {"gap": 0.003, "cohesion_law": "sjkr"}; null: averaged over.
[[nodiscard]] Json inputs_json(std::span<const study::ModelFactor> factors, const study::Setting& setting);
[[nodiscard]] std::vector<store::Table::Cell> input_cells(std::span<const study::ModelFactor> factors,
                                                          const study::Setting& setting);

/// Returns one row per setting: factors, mean, mean_error, scatter, inside (1 or 0). A probability also has mean_low
/// and mean_high. If the observable can be undefined, there is the probability that it is defined. If cases failed,
/// there are answers (probability of an answer), near_cases and near_failed.
[[nodiscard]] store::Table predictions_table(const study::ModelCases& cases, const study::ObservableModel& model,
                                             const study::Predicted& predicted);
/// Returns the output of `predict`.
[[nodiscard]] Document predictions_document(const study::ModelCases& cases, const study::ObservableModel& model,
                                            const study::Predicted& predicted);
[[nodiscard]] Result<results::predict> predictions_json(const study::ModelCases& cases,
                                                        const study::ObservableModel& model,
                                                        const study::Predicted& predicted);

/// Returns the axes for the script of a page: [{"name", "unit", "levels": texts, "numbers", "low", "high", "log"},
/// ...].
[[nodiscard]] Json axes_json(std::span<const study::ModelFactor> factors);

}  // namespace grainsweep::report
