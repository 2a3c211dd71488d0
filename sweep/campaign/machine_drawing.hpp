// Pictures of a machine before it runs.
#pragma once

#include "solver/scenes/values.hpp"
#include "sweep/campaign/machine.hpp"

#include <cstdint>
#include <functional>

namespace grainsweep::campaign {

/// Calls show(picture, time) for equally spaced times from the start to the latest end. Throws InputError if the
/// combination of inputs is impossible.
void draw_machine(const Machine& machine, const Inputs& inputs, std::int64_t frames,
                  const std::function<void(const Snapshot&, double time)>& show);

}  // namespace grainsweep::campaign
