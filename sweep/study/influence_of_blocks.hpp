// Indices from designs whose points form blocks: total indices of saltelli, elementary effects of morris. One entry per
// group of factors that change together; a single factor is a group of one.
#pragma once

#include "sweep/study/influence.hpp"

#include <vector>

namespace grainsweep::study {

/// Returns total and first-order indices of the groups. Adds notes to `influence`.
[[nodiscard]] std::vector<FactorInfluence> add_saltelli(Influence& influence, const Responses& responses,
                                                        const ResponseColumn& response);
/// Returns elementary effects of the groups. Sets effects and trends of single factors in `influence`.
[[nodiscard]] std::vector<FactorInfluence> add_morris(Influence& influence, const Responses& responses,
                                                      const ResponseColumn& response);
/// Replaces factors by their groups. A single factor keeps its other results.
void join_groups(Influence& influence, const Responses& responses, std::vector<FactorInfluence> groups);
/// Removes the errors of block designs if most places repeat an earlier case: the blocks then share runs and are not
/// independent, so their scatter understates the error.
void withdraw_errors_of_repeated_cases(Influence& influence, const Responses& responses);

}  // namespace grainsweep::study
