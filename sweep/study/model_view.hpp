// Inputs of the models of the rule `assisted`: features of a campaign's points, known before the first answer.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/schedule/assisted_judge.hpp"
#include "sweep/study/features.hpp"

#include <cstdint>
#include <vector>

namespace grainsweep::study {

/// Returns the factors of a campaign file, as model_factors() does for a stored campaign.
[[nodiscard]] std::vector<ModelFactor> model_factors(const campaign::Campaign& campaign);

/// Returns the features of the first `candidates` points of the campaign's design, which has the option "points".
/// Models are integrated over 8 scramblings of 2^12 Sobol points, mapped to the factors like the design's points. Only
/// points that `filter` accepts count. The features come from the campaign file, else by default; the answers do not
/// affect them.
/// Throws InputError at $.model.features if a feature is undefined somewhere in the ranges, and at $.where if the
/// clause excludes almost all of the ranges.
[[nodiscard]] schedule::ModelView model_view(const campaign::Campaign& campaign, std::int64_t candidates,
                                             const campaign::Filter& filter);

}  // namespace grainsweep::study
