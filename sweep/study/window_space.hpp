// What a window searches, and what stands behind a setting of it.
//
// Control factors are searched. Noise factors ("role": "noise") vary and cannot be set: probabilities and
// responses are averages over them. A factor of `for all` must meet the condition at each of its levels. A held factor
// has one value. In a setting of a window the entry of a factor that is averaged or varied so is NaN; where it has a
// number, this is its value.
//
// Behind a setting stand, for every combination of levels of `for all`, every combination of the levels of noise
// factors (32 at most) times 64 Sobol points of the other noise factors, divided by the combinations, at least 16;
// cells centred, all of one weight. Where there are more combinations levels are Sobol points, too.
#pragma once

#include "sweep/study/box_search.hpp"
#include "sweep/study/model_cases.hpp"

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace grainsweep::study {

/// A factor, by its place among the campaign's, and its one value.
using Held = std::vector<std::pair<std::size_t, double>>;

/// "CONDITION for all A, B": the condition, and the names.
struct StatedCondition {
    std::string condition;
    std::vector<std::string> for_all;
};
/// Throws WrongQuestion at --where for a `for all` without a name.
[[nodiscard]] StatedCondition split_condition(std::string_view where);

class WindowSpace {
public:
    /// Throws WrongQuestion for a name in `for_all` that is no factor, has no levels or is held, and where nothing is
    /// left to be searched.
    WindowSpace(const ModelCases& cases, const Held& held, const std::vector<std::string>& for_all, Admits admits);

    /// Settings of the searched factors, less those behind which no setting is admitted.
    [[nodiscard]] std::vector<BoxPoint> spread(std::size_t count) const;
    [[nodiscard]] std::vector<BoxPoint> about(const BoxPoint& centre, double reach, std::size_t count) const;

    /// One list for each combination of levels of `for all`; those that are not admitted are missing.
    [[nodiscard]] std::vector<std::vector<Setting>> behind(const Setting& setting) const;
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
