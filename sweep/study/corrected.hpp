// Moments of the setting `reference`, the result of a campaign with an error goal. They are computed from many cases of
// the chosen setting and from pairs with cases of NAME_reference (stats/two_levels.hpp).
#pragma once

#include "stats/two_levels.hpp"
#include "sweep/campaign/accuracy_goal.hpp"
#include "sweep/store/store.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::study {

struct Corrected {
    campaign::AccuracyGoal goal;  ///< with its setting; `reference` if only that one continues
    stats::TwoLevelCheck check;
    bool within = false;      ///< within the tolerance at two checks in a row
    double core_seconds = 0;  ///< of all cases, with the pilot
    /// Core-seconds of the cases at `reference` that would bring the statistical error alone within the tolerance;
    /// empty without pairs.
    std::optional<double> alone;
    bool chosen_alone = false;  ///< a pilot, or a later check, found `reference` without pairs cheaper
    /// Number of cases at the setting of the goal before a check chose `reference` alone; empty: no check did.
    std::optional<std::int64_t> before_alone;

    [[nodiscard]] std::string verdict() const;
};

/// Returns the name of a setting's campaign beside the campaign c, such as "c_reference".
[[nodiscard]] std::string name_at(std::string_view campaign, std::string_view setting);

struct FirstValues {
    std::vector<double> values;      ///< by point; NaN: no value
    std::int64_t without_value = 0;  ///< cases
};
/// Returns the values at the first points of a campaign, only up to the first point that is not settled yet.
[[nodiscard]] FirstValues first_values(const store::Store& store, std::string_view campaign,
                                       std::string_view observable, std::int64_t points);

/// Factors of the first points of a campaign, scaled to 0 to 1.
struct FirstFactors {
    std::vector<double> rows;
    std::size_t dimensions = 0;

    [[nodiscard]] stats::Rows view() const { return {rows, dimensions}; }
};
[[nodiscard]] FirstFactors first_factors(const store::Store& store, std::string_view campaign, std::int64_t points);

/// Returns the statistics that are judged.
[[nodiscard]] std::vector<stats::Statistic> gates_of(const campaign::AccuracyGoal& goal);

/// Returns a check in the form of the archive: the corrected moments, with `together` as their errors.
[[nodiscard]] store::ConvergenceRow row_of(const stats::TwoLevelCheck& check, const campaign::AccuracyGoal& goal,
                                           std::int64_t excluded, bool converged);

/// Returns the moments from stored cases; empty for a campaign without such a goal, and before its first check.
[[nodiscard]] std::optional<Corrected> corrected_of(const store::Store& store, const store::CampaignRecord& campaign);

}  // namespace grainsweep::study
