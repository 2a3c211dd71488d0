// What `converge` and `sensitivity` print: rows for people and rows for programs.
#pragma once

#include "sweep/report/history.hpp"
#include "sweep/report/influence.hpp"

#include <nlohmann/json_fwd.hpp>

#include <span>
#include <string>

namespace grainsweep::report {

/// The five statistics of all settled points: value, 95 % error, what the rule compares with the tolerance, and
/// whether it is a gate that holds the campaign back.
[[nodiscard]] store::Table statistics_table(const History& history);
/// The same of every finished case, not judged; empty where there is nothing provisional.
[[nodiscard]] store::Table provisional_table(const History& history);
/// One row per check for people, some 20 of them where there are more: every statistic with its error.
[[nodiscard]] store::Table checks_table(const History& history);
/// One row per check in the columns of the view convergence_history and `provisional` (0), the last row over all
/// settled points.
[[nodiscard]] store::Table checks_rows(const Responses& responses, const ResponseColumn& response,
                                       const History& history);
/// The same columns of the provisional figures, `provisional` 1: one row, or none.
[[nodiscard]] store::Table provisional_rows(const Responses& responses, const ResponseColumn& response,
                                            const History& history);
/// Lattices of one family: moments and how far they moved since the coarser one, as a share of what a rule compares.
[[nodiscard]] store::Table lattice_table(std::span<const LatticeStep> steps);
/// The same for people: "2.679 (30 %)".
[[nodiscard]] store::Table lattice_lines(std::span<const LatticeStep> steps);
/// Everything `converge` knows of one campaign as one value.
[[nodiscard]] nlohmann::ordered_json to_json(const Responses& responses, const ResponseColumn& response,
                                             const History& history, std::span<const LatticeStep> lattices);

/// One row per factor for people, the most influential first.
[[nodiscard]] store::Table influence_table(const Influence& influence);
/// One row per factor for programs, in the campaign's order; what the method does not give is absent.
[[nodiscard]] store::Table influence_rows(const Responses& responses, const ResponseColumn& response,
                                          const Influence& influence);
[[nodiscard]] nlohmann::ordered_json to_json(const Responses& responses, const ResponseColumn& response,
                                             const Influence& influence);

}  // namespace grainsweep::report
