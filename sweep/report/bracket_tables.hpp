// What a refine campaign has found, as a line, tables and JSON.
#pragma once

#include "sweep/store/store.hpp"
#include "sweep/study/brackets.hpp"

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace grainsweep::report {

/// "retention passes 0.5 along cohesion: 5 of 6 brackets are 1000 J/m3 wide or less, 1 is above throughout".
[[nodiscard]] std::string brackets_line(const study::Brackets& brackets);
/// For people: one row per combination.
[[nodiscard]] store::Table brackets_table(const study::Brackets& brackets);
/// For programs: the same with every number in a column of its own.
[[nodiscard]] store::Table brackets_rows(const study::Brackets& brackets, const std::string& campaign);
[[nodiscard]] nlohmann::ordered_json to_json(const study::Brackets& brackets);

}  // namespace grainsweep::report
