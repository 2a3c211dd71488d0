// How densely powder has settled in a vessel.
#pragma once

#include "solver/dem/engine.hpp"

namespace grainsweep::observables {

/// Solid fraction of a settled powder between z = bottom + 3 D and 3 D below the height that 95 % of the centres do not
/// reach, in a vessel of this cross-section; NaN where it is lower than that.
[[nodiscard]] double settled_fraction(const dem::State& state, double bottom, double diameter, double section);

}  // namespace grainsweep::observables
