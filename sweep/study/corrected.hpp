// What a campaign with an error goal answers: the moments of the setting `reference`, from the many cases of the chosen
// setting and the pairs with those of NAME_reference (stats/two_levels.hpp).
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
    campaign::AccuracyGoal goal;  ///< its setting is known; `reference` where that goes on alone
    stats::TwoLevelCheck check;
    bool within = false;      ///< at two checks in a row
    double core_seconds = 0;  ///< of all cases, those of the pilot included
    /// Of the cases at `reference` that would bring the statistical error alone within the tolerance; none without
    /// pairs.
    std::optional<double> alone;
    bool chosen_alone = false;  ///< a pilot, or a later check, found `reference` without pairs cheaper
    /// Cases at the setting of the goal before a check chose `reference` alone; none: no check did.
    std::optional<std::int64_t> before_alone;

    [[nodiscard]] std::string verdict() const;
};

/// "c_reference": the campaign of a setting beside the campaign c.
[[nodiscard]] std::string name_at(std::string_view campaign, std::string_view setting);

struct FirstValues {
    std::vector<double> values;      ///< by point; NaN where there is none
    std::int64_t without_value = 0;  ///< cases
};
/// Values at the first points of a campaign; fewer points where one is not settled yet.
[[nodiscard]] FirstValues first_values(const store::Store& store, std::string_view campaign,
                                       std::string_view observable, std::int64_t points);

/// The factors of the first points of a campaign, 0 to 1 each.
struct FirstFactors {
    std::vector<double> rows;
    std::size_t dimensions = 0;

    [[nodiscard]] stats::Rows view() const { return {rows, dimensions}; }
};
[[nodiscard]] FirstFactors first_factors(const store::Store& store, std::string_view campaign, std::int64_t points);

/// The statistics that are judged.
[[nodiscard]] std::vector<stats::Statistic> gates_of(const campaign::AccuracyGoal& goal);

/// A check as the archive keeps it: the corrected moments with `together` for their errors.
[[nodiscard]] store::ConvergenceRow row_of(const stats::TwoLevelCheck& check, const campaign::AccuracyGoal& goal,
                                           std::int64_t excluded, bool converged);

/// From what is stored; none for a campaign without such a goal, and before its first check.
[[nodiscard]] std::optional<Corrected> corrected_of(const store::Store& store, const store::CampaignRecord& campaign);

}  // namespace grainsweep::study
