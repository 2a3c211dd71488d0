// What a refine campaign has found: where its observable passes the threshold, combination by combination.
#pragma once

#include "sweep/designs/refine.hpp"
#include "sweep/store/store.hpp"

#include <nlohmann/json_fwd.hpp>

#include <optional>
#include <string>
#include <vector>

namespace grainsweep::report {

struct Brackets {
    std::string factor, factor_unit, observable, observable_unit;
    double threshold = 0, width = 0;
    std::vector<std::string> others;               ///< factors with levels, in their order
    std::vector<std::vector<std::string>> levels;  ///< of each combination, as words
    std::vector<designs::Bracket> found;           ///< the same combinations
};

/// None for a campaign of another design.
[[nodiscard]] std::optional<Brackets> brackets_of(const store::Store& store, const store::CampaignRecord& record);

/// "retention passes 0.5 along cohesion: 5 of 6 brackets are 1000 J/m3 wide or less, 1 is above throughout".
[[nodiscard]] std::string brackets_line(const Brackets& brackets);
/// For people: one row per combination.
[[nodiscard]] store::Table brackets_table(const Brackets& brackets);
/// For programs: the same with every number in a column of its own.
[[nodiscard]] store::Table brackets_rows(const Brackets& brackets, const std::string& campaign);
[[nodiscard]] nlohmann::ordered_json to_json(const Brackets& brackets);

}  // namespace grainsweep::report
