// What the models of the rule `assisted` see of the points of a campaign, known before the first answer.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/schedule/assisted_judge.hpp"
#include "sweep/study/features.hpp"

#include <cstdint>
#include <vector>

namespace grainsweep::study {

/// The factors of a campaign that was read, as model_factors() has those of a stored one.
[[nodiscard]] std::vector<ModelFactor> model_factors(const campaign::Campaign& campaign);

/// Features of the first `candidates` points of the campaign's design, which takes "points". Models are integrated over
/// 8 scramblings of 2^12 Sobol points, mapped to the factors like the design's points. Only points that `filter`
/// accepts count. No features are tried by the answers: they come from the campaign file, else by default.
/// Throws WrongQuestion at $.model.features where a feature is undefined somewhere in the ranges, and at $.where where
/// next to nothing of the ranges is left.
[[nodiscard]] schedule::ModelView model_view(const campaign::Campaign& campaign, std::int64_t candidates,
                                             const campaign::Filter& filter);

}  // namespace grainsweep::study
