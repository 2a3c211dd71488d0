// Keys of a campaign file, one table per section. The reader checks against the tables and the JSON schema prints them,
// so both have the same keys.
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
    /// For word and words: the words; for whole: words that are also allowed. Of words, one that ends with a colon is
    /// the beginning of a text.
    std::span<const std::string_view> words = {};
    bool required = false;
};

[[nodiscard]] constexpr Key needed(Key key) {
    key.required = true;
    return key;
}

/// Key allowed in every object and ignored: a text or a list of texts.
inline constexpr std::string_view notes_key = "notes";

[[nodiscard]] std::span<const Key> campaign_keys();
[[nodiscard]] std::span<const Key> factor_keys();
/// Returns those of factor_keys() that define the values of a factor; a factor has exactly one.
[[nodiscard]] std::span<const std::string_view> range_keys();
[[nodiscard]] std::span<const Key> uniform_keys();
[[nodiscard]] std::span<const Key> normal_keys();
[[nodiscard]] std::span<const Key> lognormal_keys();
[[nodiscard]] std::span<const Key> weibull_keys();
[[nodiscard]] std::span<const Key> gumbel_keys();
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
/// Returns "kind", the design's options without their defaults and, if it has rows, "file".
[[nodiscard]] std::vector<Key> design_keys(const designs::DesignInfo& design);

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

/// Returns names that a campaign cannot have, because tables and views of the database have them.
[[nodiscard]] std::span<const std::string_view> reserved_names();

}  // namespace grainsweep::campaign
