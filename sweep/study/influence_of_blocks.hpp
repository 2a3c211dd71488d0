// Figures from designs whose points belong together in blocks: total indices of saltelli, effects of morris. One entry
// a group of factors that move together; a factor by itself is a group.
#pragma once

#include "sweep/study/influence.hpp"

#include <vector>

namespace grainsweep::study {

/// Computes total and first-order indices of the groups, and notes of them in `influence`.
[[nodiscard]] std::vector<FactorInfluence> add_saltelli(Influence& influence, const Responses& responses,
                                                        const ResponseColumn& response);
/// Computes elementary effects of the groups, and of single factors in `influence`, which get a trend.
[[nodiscard]] std::vector<FactorInfluence> add_morris(Influence& influence, const Responses& responses,
                                                      const ResponseColumn& response);
/// Puts the groups in the place of their factors; a factor by itself keeps what else is known of it.
void join_groups(Influence& influence, const Responses& responses, std::vector<FactorInfluence> groups);
/// Withdraws the errors of figures from blocks of points where most places repeat an earlier case: the blocks share
/// their runs, and say of the scatter between them less than their number promises.
void withdraw_errors_of_repeated_cases(Influence& influence, const Responses& responses);

}  // namespace grainsweep::study
