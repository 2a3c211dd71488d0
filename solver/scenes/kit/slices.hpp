// Steps of an engine to a stop of the experiment, in slices of the caller.
#pragma once

#include "solver/dem/engine.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace grainsweep::kit {

/// Runs from `step` to `stop`, or to the first step whose time is not before `until`; at least one step. Returns the
/// step reached; an unsound state ends the run early. The slices do not change the stops.
[[nodiscard]] inline std::int64_t run_towards(dem::Engine& engine, std::int64_t step, std::int64_t stop,
                                              double time_step, double until) {
    const double left = std::ceil(until / time_step - static_cast<double>(step));
    const std::int64_t most = stop - step;
    const std::int64_t steps = left < static_cast<double>(most) ? std::max<std::int64_t>(1, std::llround(left)) : most;
    const std::int64_t before = engine.work().steps;
    engine.run(steps);
    return step + engine.work().steps - before;
}

}  // namespace grainsweep::kit
