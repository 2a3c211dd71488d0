// What a campaign file may say, in one table per section: the reader checks against it and the JSON schema
// prints it, so that neither can know a key which the other does not.
#pragma once

#include "solver/scenes/values.hpp"
#include "sweep/designs/design.hpp"

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

namespace grainsweep::campaign {

struct Key {
    enum class Kind { text, word, words, whole, number, flag, value, object, array };
    std::string_view name;
    Kind kind = Kind::text;
    std::string_view meaning;
    std::string_view standard = {};  ///< JSON text of the default; empty: none
    Interval bounds = {};            ///< of whole and number
    /// Of word and words; of whole: words that may stand in its place.
    std::span<const std::string_view> words = {};
    bool required = false;
};

[[nodiscard]] constexpr Key needed(Key key) {
    key.required = true;
    return key;
}

/// Allowed in every object and ignored: a text or a list of texts.
inline constexpr std::string_view notes_key = "notes";

[[nodiscard]] std::span<const Key> campaign_keys();
[[nodiscard]] std::span<const Key> factor_keys();
/// Those of factor_keys() that give a factor its values: it has one of them.
[[nodiscard]] std::span<const std::string_view> range_keys();
[[nodiscard]] std::span<const Key> uniform_keys();
[[nodiscard]] std::span<const Key> normal_keys();
[[nodiscard]] std::span<const Key> lognormal_keys();
[[nodiscard]] std::span<const Key> triangular_keys();
[[nodiscard]] std::span<const Key> beta_keys();
[[nodiscard]] std::span<const Key> sample_keys();
[[nodiscard]] std::span<const Key> convergence_keys();
[[nodiscard]] std::span<const Key> accuracy_keys();
[[nodiscard]] std::span<const Key> model_keys();
[[nodiscard]] std::span<const Key> calibration_keys();
[[nodiscard]] std::span<const Key> experiment_keys();
[[nodiscard]] std::span<const Key> target_keys();
[[nodiscard]] std::span<const Key> stop_keys();
[[nodiscard]] std::span<const Key> limits_keys();
[[nodiscard]] std::span<const Key> execution_keys();
/// "kind", the design's options without their defaults and, where it takes rows, "file".
[[nodiscard]] std::vector<Key> design_keys(const designs::DesignInfo& design);

/// Limits of time below these would end every worker before it can answer, s.
inline constexpr double shortest_limit = 0.1;
inline constexpr double shortest_silence = 3;  ///< a few signs of life

/// Shape parameters of a beta distribution.
inline constexpr Interval shapes_of_beta{0.05, 1e4};
/// Rows of a sample, which are kept with the campaign.
inline constexpr std::size_t most_sample_rows = 20'000;

/// Features of a response model.
inline constexpr std::size_t most_features = 30;

/// Letters of a campaign's name: NAME.db must be a file name.
inline constexpr std::size_t longest_campaign_name = 128;

/// Names a campaign cannot have: the tables and views of the database are called so.
[[nodiscard]] std::span<const std::string_view> reserved_names();

}  // namespace grainsweep::campaign
