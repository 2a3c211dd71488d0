// Response models and what they predict, as text, tables and JSON.
#pragma once

#include "stats/response_model.hpp"
#include "sweep/report/cases_near.hpp"
#include "sweep/report/response_models.hpp"
#include "sweep/store/store.hpp"

#include <nlohmann/json_fwd.hpp>

#include <span>
#include <string>
#include <vector>

namespace grainsweep::report {

/// What a model rests on and how far its errors can be believed, in a few lines; then its notes, "note: " each.
[[nodiscard]] std::string model_lines(const ObservableModel& model);
/// {"observable", "cases", "rests_on", "undefined", "leave_one_out_error", "coverage_50", "coverage_95", "noise_share",
/// "features", "learned_map", "notes"}
[[nodiscard]] nlohmann::ordered_json model_json(const ObservableModel& model);

/// {"gap": 0.003, "cohesion_law": "sjkr"}
[[nodiscard]] nlohmann::ordered_json inputs_json(std::span<const ModelFactor> factors, const Setting& setting);
[[nodiscard]] std::vector<store::Table::Cell> input_cells(std::span<const ModelFactor> factors, const Setting& setting);

/// What a model predicts at settings.
struct Predicted {
    std::vector<Setting> settings;
    std::vector<stats::Prediction> predictions;  ///< NaN where no case near has an answer, unless extrapolated
    std::vector<double> defined;                 ///< probability that the observable is defined
    std::vector<Near> near;
};
/// Throws WrongQuestion where a feature has no number.
[[nodiscard]] Predicted predict(const ModelCases& cases, const ObservableModel& model, std::vector<Setting> settings,
                                bool extrapolate);

/// One row per setting: factors, mean, mean_error, scatter, inside (1 or 0), where the observable can be undefined the
/// probability that it is not, and where cases failed answers_near (1 or 0), near_cases and near_failed.
[[nodiscard]] store::Table predictions_table(const ModelCases& cases, const ObservableModel& model,
                                             const Predicted& predicted);
/// "no case near x = 0.05 has an answer: 5 of the 5 nearest cases failed (5 crashed)", and how many such settings there
/// are; empty: none.
[[nodiscard]] std::string failures_near(const ModelCases& cases, const Predicted& predicted);
/// {"campaign", "observable", "points": [...], "model": {...}}
[[nodiscard]] nlohmann::ordered_json predictions_json(const ModelCases& cases, const ObservableModel& model,
                                                      const Predicted& predicted);

}  // namespace grainsweep::report
