// Results of a refine campaign: the threshold crossing of its observable for each combination of levels.
#pragma once

#include "sweep/designs/refine.hpp"
#include "sweep/store/store.hpp"

#include <optional>
#include <string>
#include <vector>

namespace grainsweep::study {

struct Brackets {
    std::string factor, factor_unit, observable, observable_unit;
    double threshold = 0, width = 0;
    std::vector<std::string> others;               ///< factors with levels, in their order
    std::vector<std::vector<std::string>> levels;  ///< levels of each combination, as words
    std::vector<designs::Bracket> found;           ///< one bracket per combination
};

/// Returns the brackets; empty for a campaign of another design.
[[nodiscard]] std::optional<Brackets> brackets_of(const store::Store& store, const store::CampaignRecord& record);

}  // namespace grainsweep::study
