// A scene at the ends of its declared ranges: refused in a sentence, reported unstable, or answered in numbers.
#pragma once

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/case.hpp"

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace grainsweep::tests {

using Changes = std::vector<std::pair<const char*, Value>>;

/// Each end of each interval, others at their defaults: has a cost, or is refused in a sentence; conditions name
/// parameters that exist.
void expect_bounds_are_made_or_refused(const SceneInfo& scene);

/// What `solve` and the workers make of each change: expects finite numbers, or a sentence. How many came to what.
[[nodiscard]] std::map<campaign::Outcome, int> outcomes_of(const SceneInfo& scene, const Inputs& inputs,
                                                           const std::vector<Changes>& table);

}  // namespace grainsweep::tests
