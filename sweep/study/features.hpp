// Features of a response model: numbers computed from the factors of a setting.
//
//   by default   every continuous factor, as its logarithm if high/low >= 2.5 and low > 0; the same for numeric levels.
//                For levels that are words: an indicator (1 or 0) for each word except the first
//   as written   "model": {"features": ["friction", "log(diameter)", "gap/diameter"]} in the campaign file: SQL
//                expressions of factors
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/study/responses.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace grainsweep::study {

/// Factor of a model. In a setting it has one number: its value in its unit or, for words, the index of the word.
struct ModelFactor : campaign::Factor {
    bool noise = false;                   ///< noise factor ("role" of the campaign file): it varies and cannot be set
    std::vector<double> numbers = {};     ///< numeric levels, ascending; empty: a range, or words
    std::vector<std::string> words = {};  ///< levels that are words; empty: numbers
    std::size_t unlisted = 0;             ///< number of words at the end of `words` that the campaign does not list
    /// Whether the factor counts at a setting, by its `when`; empty: it always counts.
    std::function<bool(std::span<const double> setting)> counts = {};
    std::size_t order = 0;  ///< order in which the factors with a `when` are evaluated
    double standard = 0;    ///< its value where it does not count

    // Return the ends of the range, or the smallest and largest of `numbers`.
    [[nodiscard]] double low() const;
    [[nodiscard]] double high() const;
    /// Returns the number of words that may be chosen.
    [[nodiscard]] std::size_t choices() const { return words.size() - unlisted; }
    [[nodiscard]] bool is_word() const { return !words.empty(); }
    /// Returns the smallest number that a design can use.
    [[nodiscard]] double smallest() const { return distribution() == nullptr ? low() : number(0); }
    [[nodiscard]] bool varies() const { return is_word() ? words.size() > 1 : high() > low(); }
    /// Returns the value in the campaign file of a number in a setting.
    [[nodiscard]] Value value_of(double number) const;
    /// Returns this value as text: the shortest that reads back as the same number. For NaN (averaged over) "varies".
    [[nodiscard]] std::string text(double number) const;
};

/// Setting: one number per factor, in the campaign's order.
using Setting = std::vector<double>;

/// Return the factors of a campaign, and its settings, one per row.
[[nodiscard]] std::vector<ModelFactor> model_factors(const Responses& responses);
[[nodiscard]] std::vector<Setting> settings_of(const Responses& responses, std::span<const ModelFactor> factors);

struct Features {
    std::vector<std::string> names;                                          ///< as expressions: "log(diameter)"
    std::function<std::vector<double>(std::span<const double> setting)> of;  ///< one number per name; NaN: undefined
};

/// Replaces every factor that does not count by its default.
void fold(std::span<const ModelFactor> factors, Setting& setting);
/// Returns a setting as models use it: a factor that does not count is in the middle of its range, or at its first
/// level, whatever its default.
[[nodiscard]] Setting as_seen(std::span<const ModelFactor> factors, Setting setting);
/// Sets factor j to x. If it is a share, the other shares are scaled so that all add to one (Cox 1971, Biometrika 58,
/// 155), except the shares in `kept`.
void place(std::span<const ModelFactor> factors, Setting& setting, std::size_t j, double x,
           std::span<const std::size_t> kept = {});
/// Returns the sum of the shares; empty if no factor is a share.
[[nodiscard]] std::optional<double> sum_of_shares(std::span<const ModelFactor> factors, const Setting& setting);

/// Returns the features of every setting, row after row.
[[nodiscard]] std::vector<double> rows_of(const Features& features, std::span<const Setting> settings);
/// Box of the features: smallest and largest value of each, the unit of the model's lengths. For a constant feature the
/// box is one unit wide; without rows it is the unit box.
struct FeatureBox {
    std::vector<double> low, high;
};
[[nodiscard]] FeatureBox box_of(std::span<const double> rows, std::size_t width);

/// Ratio of two factors: log(a/b) replaces feature a.
struct Ratio {
    std::size_t over = 0, under = 0;  ///< indices of the factors of numerator and denominator
};

[[nodiscard]] Features default_features(std::span<const ModelFactor> factors, std::span<const Ratio> ratios = {});
/// Returns the features of the campaign file. Throws InputError at $.model.features[k] for an expression that SQLite
/// cannot evaluate.
[[nodiscard]] Features written_features(std::span<const ModelFactor> factors, std::span<const std::string> expressions);
/// Returns the ratios to try: of two varied positive factors with the same unit, which is not 1.
[[nodiscard]] std::vector<Ratio> candidate_ratios(std::span<const ModelFactor> factors);

/// Throws InputError if a feature of the campaign file cannot be evaluated.
void check_features(const campaign::Campaign& campaign);

}  // namespace grainsweep::study
