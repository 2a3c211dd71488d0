// A machine before it runs, as a picture: walls where they stand at a time, particles where they are filled in, and as
// wire frames the domain and the regions of fillings, feeds and measurements.
#pragma once

#include "solver/machine/filling.hpp"
#include "solver/machine/spec.hpp"
#include "solver/scenes/values.hpp"

namespace grainsweep::machine {

/// Phases last as long as they can. `time`: s since the start.
[[nodiscard]] Snapshot drawing(const Spec& spec, const Filled& filled, double time);
/// Returns the time at which the last phase ends, s.
[[nodiscard]] double longest_time(const Spec& spec);

}  // namespace grainsweep::machine
