// What a campaign will probably cost, before anything is run.
#pragma once

#include "sweep/campaign/campaign.hpp"

#include <cstdint>
#include <span>

namespace grainsweep::campaign {

struct Forecast {
    std::int64_t places = 0;     ///< cases as placed in the design
    std::int64_t questions = 0;  ///< of those different from each other
    std::int64_t proven = 0;     ///< questions whose answer is known without simulation
    double total_seconds = 0;    ///< of one plain core
    double longest_seconds = 0;  ///< the most expensive question
};

/// Adds the scene's own estimates over different questions without a proven answer.
[[nodiscard]] Forecast forecast(const SceneInfo& scene, std::span<const PlacedCase> cases);

}  // namespace grainsweep::campaign
