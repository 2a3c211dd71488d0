// Settings that a window searches, and the full settings that each of them stands for.
//
// Control factors are searched. Noise factors ("role": "noise") vary and cannot be set: probabilities and responses are
// averages over them. The condition must hold at each level of a factor of `for all`. A held factor has one value. In a
// setting of a window, the entry of a factor that is averaged or varied in this way is NaN; any number is the factor's
// value.
//
// The full settings of a window's setting: for every combination of levels of `for all`, every combination of the
// levels of noise factors (at most 32), times Sobol points of the other noise factors. There are 64 Sobol points
// divided by the number of combinations, but at least 16. Cells are centred, and all full settings have the same
// weight. If there are more than 32 combinations, the levels are Sobol points, too.
#pragma once

#include "sweep/study/box_search.hpp"
#include "sweep/study/model_cases.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace grainsweep::study {

/// Held factors: index of each among the campaign's factors, and its value.
using Held = std::vector<std::pair<std::size_t, double>>;

/// Parts of "CONDITION for all A, B": the condition and the names.
struct StatedCondition {
    std::string condition;
    std::vector<std::string> for_all;
};
/// Splits a text into these parts. Throws InputError at --where for a `for all` without a name.
[[nodiscard]] StatedCondition split_condition(std::string_view where);

class WindowSpace {
public:
    /// Throws InputError for a name in `for_all` that is no factor, has no levels or is held, and if no factor is
    /// left to search.
    WindowSpace(const ModelCases& cases, const Held& held, const std::vector<std::string>& for_all, Admits admits);

    /// Returns settings of the searched factors, without those that have no admitted full setting.
    [[nodiscard]] std::vector<BoxPoint> spread(std::size_t count) const;
    [[nodiscard]] std::vector<BoxPoint> about(const BoxPoint& centre, double reach, std::size_t count) const;

    /// Returns one list of full settings for each combination of levels of `for all`, without settings that are not
    /// admitted.
    [[nodiscard]] std::vector<std::vector<Setting>> behind(const Setting& setting) const;
    /// Returns the part of a full setting that is searched; nothing if a held factor has another value.
    [[nodiscard]] std::optional<Setting> searched_part(const Setting& full) const;
    [[nodiscard]] bool averages() const { return !noise_.empty() || !every_.empty(); }
    [[nodiscard]] bool searches(std::size_t factor) const;
    [[nodiscard]] std::vector<std::string> noise_names() const;

private:
    [[nodiscard]] std::vector<BoxPoint> embedded(std::vector<BoxPoint> points) const;
    [[nodiscard]] std::vector<Setting> noise_points(const std::vector<std::size_t>& averaged) const;

    std::vector<ModelFactor> factors_, searched_factors_;
    std::vector<std::size_t> searched_, noise_, every_;
    Setting empty_;  ///< held values, NaN elsewhere
    Admits admits_;
};

}  // namespace grainsweep::study
