#include "sweep/campaign/forecast.hpp"

#include <algorithm>
#include <string_view>
#include <unordered_set>

namespace grainsweep::campaign {

Forecast forecast(const SceneInfo& scene, std::span<const PlacedCase> cases) {
    Forecast total;
    std::unordered_set<std::string_view> seen;
    for (const auto& placed : cases) {
        ++total.places;
        if (!seen.insert(placed.question.id).second) continue;
        ++total.questions;
        if (scene.proven_answer && scene.proven_answer(placed.question.inputs)) {
            ++total.proven;
            continue;
        }
        const double seconds = scene.estimate_cost ? scene.estimate_cost(placed.question.inputs) : 0;
        total.total_seconds += seconds;
        total.longest_seconds = std::max(total.longest_seconds, seconds);
    }
    return total;
}

}  // namespace grainsweep::campaign
