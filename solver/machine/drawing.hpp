// Picture of a machine before it runs: walls at a given time, particles as filled in, and wire frames of the domain and
// of the regions of fillings, feeds and measurements.
#pragma once

#include "solver/machine/filling.hpp"
#include "solver/machine/spec.hpp"
#include "solver/scenes/values.hpp"

namespace grainsweep::machine {

/// Draws the machine, assuming the longest duration of every phase. `time`: s since the start.
[[nodiscard]] Snapshot drawing(const Spec& spec, const Filled& filled, double time);
/// Adds the middle surfaces of shells of level sets that glued spheres fill, with the edges of their packing.
void add_cells(Snapshot& picture, const Spec& spec);
/// Returns the time at which the last phase ends, s.
[[nodiscard]] double longest_time(const Spec& spec);

}  // namespace grainsweep::machine
