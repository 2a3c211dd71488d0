// Pictures of a machine before it runs.
#pragma once

#include "solver/scenes/values.hpp"
#include "sweep/campaign/machine.hpp"

#include <cstdint>
#include <functional>
#include <string>

namespace grainsweep::campaign {

/// Calls show(picture, time) for equally spaced times from the start to the latest end. If the fillings do not fit, the
/// machine is drawn without particles; returns why they do not, in one sentence, else empty. Throws InputError if the
/// combination of inputs is impossible otherwise.
[[nodiscard]] std::string draw_machine(const Machine& machine, const Inputs& inputs, std::int64_t frames,
                                       const std::function<void(const Snapshot&, double time)>& show);

}  // namespace grainsweep::campaign
