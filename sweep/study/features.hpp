// What a response model sees of a setting: numbers made of the campaign's factors.
//
//   by default   every continuous factor, its logarithm where high/low >= 2.5 and low > 0; of a factor with levels that
//                are numbers the same; of one with words a column for each but the first, 1 where it has that word
//   as written   "model": {"features": ["friction", "log(diameter)", "gap/diameter"]} in the campaign file: SQL
//                expressions over factors
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

/// A factor as a model takes it. A setting gives each factor one number: its value in its unit or, for words, the index
/// of the word.
struct ModelFactor {
    std::string name, unit;
    double low = 0, high = 0;  ///< of numbers: the range as FactorColumn has it, or the smallest and largest level
    bool log = false;          ///< the range is divided logarithmically
    std::optional<stats::Distribution> distribution = {};  ///< which settings are drawn from; none: evenly
    bool noise = false;                                    ///< it varies and cannot be set: "role" of the campaign file
    std::vector<double> numbers;     ///< levels that are numbers, growing; empty: a range, or words
    std::vector<std::string> words;  ///< levels that are words; empty: numbers
    std::size_t unlisted = 0;        ///< of the words those at the end that the campaign does not list
    std::optional<double> step;      ///< of a range: its values are multiples of this
    bool share = false;              ///< it and the other shares add to one
    /// Whether it counts beside the values of the other factors, by its `when`; empty: it always does.
    std::function<bool(std::span<const double> setting)> counts;
    std::size_t order = 0;  ///< among the factors with a `when`, in which they are decided
    double standard = 0;    ///< what it is where it does not count

    /// Words that may be chosen.
    [[nodiscard]] std::size_t choices() const { return words.size() - unlisted; }
    [[nodiscard]] bool is_word() const { return !words.empty(); }
    /// The smallest number that a design may ask.
    [[nodiscard]] double smallest() const { return distribution ? distribution->quantile(0) : low; }
    [[nodiscard]] bool varies() const { return is_word() ? words.size() > 1 : high > low; }
    /// The value as in the campaign file.
    [[nodiscard]] Value value(double number) const;
    /// The same as text, to be read again: the shortest that is the same number; of NaN, averaged over, "varies".
    [[nodiscard]] std::string text(double number) const;
};

/// One number per factor, in the campaign's order.
using Setting = std::vector<double>;

/// The factors of a campaign, and their columns turned into settings (one per row).
[[nodiscard]] std::vector<ModelFactor> model_factors(const Responses& responses);
[[nodiscard]] std::vector<Setting> settings_of(const Responses& responses, std::span<const ModelFactor> factors);

struct Features {
    std::vector<std::string> names;  ///< as a reader would write them: "log(diameter)"
    std::function<std::vector<double>(std::span<const double> setting)> of;  ///< one number per name; NaN: undefined
};

/// Puts its default in the place of every factor that does not count.
void fold(std::span<const ModelFactor> factors, Setting& setting);
/// A setting as models see it: a factor that does not count stands in the middle of its range, or at its first level,
/// wherever its default lies.
[[nodiscard]] Setting as_seen(std::span<const ModelFactor> factors, Setting setting);
/// Puts x in the place of factor j. Of a share the others are stretched so that all add to one (Cox 1971, Biometrika
/// 58, 155); those of `kept` stay.
void place(std::span<const ModelFactor> factors, Setting& setting, std::size_t j, double x,
           std::span<const std::size_t> kept = {});
/// Sum of the shares; none where no factor is a share.
[[nodiscard]] std::optional<double> sum_of_shares(std::span<const ModelFactor> factors, const Setting& setting);

/// Features of every setting, one row after the other.
[[nodiscard]] std::vector<double> rows_of(const Features& features, std::span<const Setting> settings);
/// Smallest and largest of each feature: the box that lengths are measured in. Of one that is the same everywhere the
/// box is one unit wide, and without rows it is the unit box.
struct FeatureBox {
    std::vector<double> low, high;
};
[[nodiscard]] FeatureBox box_of(std::span<const double> rows, std::size_t width);

/// log(a/b) takes the place of feature a.
struct Ratio {
    std::size_t over = 0, under = 0;  ///< indices of factors
};

[[nodiscard]] Features default_features(std::span<const ModelFactor> factors, std::span<const Ratio> ratios = {});
/// Throws WrongQuestion at $.model.features[k] for what SQLite cannot evaluate over the factors.
[[nodiscard]] Features written_features(std::span<const ModelFactor> factors, std::span<const std::string> expressions);
/// Ratios worth a trial: of two factors of one unit that is not 1, both positive and varied.
[[nodiscard]] std::vector<Ratio> candidate_ratios(std::span<const ModelFactor> factors);

/// Throws WrongQuestion where a feature of the campaign file cannot be evaluated.
void check_features(const campaign::Campaign& campaign);

}  // namespace grainsweep::study
