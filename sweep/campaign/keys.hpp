// Keys of a campaign file, one table per section. The reader checks against the tables and the JSON schema prints them,
// so both have the same keys.
#pragma once

#include "solver/field.hpp"
#include "solver/scenes/values.hpp"
#include "sweep/designs/design.hpp"

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace grainsweep::campaign {

/// Key allowed in every object and ignored: a text or a list of texts.
inline constexpr std::string_view notes_key = "notes";
/// Key ignored in every object: where an editor finds the schema of the file.
inline constexpr std::string_view schema_key = "$schema";

extern const std::span<const Field> campaign_keys;
extern const std::span<const Field> factor_keys;
/// Those of factor_keys that define the values of a factor; a factor has exactly one.
extern const std::span<const std::string_view> range_keys;
extern const std::span<const Field> uniform_keys;
extern const std::span<const Field> normal_keys;
extern const std::span<const Field> lognormal_keys;
extern const std::span<const Field> weibull_keys;
extern const std::span<const Field> gumbel_keys;
extern const std::span<const Field> triangular_keys;
extern const std::span<const Field> beta_keys;
extern const std::span<const Field> sample_keys;
/// Returns the distributions with figures, in the order of stats::Distribution::Form.
[[nodiscard]] std::span<const Type> distribution_types();
extern const std::span<const Field> convergence_keys;
extern const std::span<const Field> accuracy_keys;
extern const std::span<const Field> model_keys;
extern const std::span<const Field> calibration_keys;
extern const std::span<const Field> experiment_keys;
extern const std::span<const Field> target_keys;
extern const std::span<const Field> without_value_keys;
extern const std::span<const Field> stop_keys;
extern const std::span<const Field> limits_keys;
extern const std::span<const Field> execution_keys;
/// Returns "kind", the design's options without their defaults and, if it has rows, "file".
[[nodiscard]] std::vector<Field> design_keys(const designs::DesignInfo& design);

/// Shortest limits of time, s; shorter ones would end every worker before it can answer.
inline constexpr double shortest_limit = 0.1;
inline constexpr double shortest_silence = 3;  ///< a few heartbeats

/// Shape parameters of a beta distribution.
inline constexpr Interval shapes_of_beta{0.05, 1e4};
/// Most rows of a sample, which is stored with the campaign.
inline constexpr std::size_t most_sample_rows = 20'000;

/// Most features of a response model.
inline constexpr std::size_t most_features = 30;

/// Longest name of a campaign, because NAME.db must be a file name.
inline constexpr std::size_t longest_campaign_name = 128;

/// Names that a campaign cannot have, because tables and views of the database have them.
extern const std::span<const std::string_view> reserved_names;

}  // namespace grainsweep::campaign
