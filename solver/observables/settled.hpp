// Density of settled powder in a vessel.
#pragma once

#include "solver/dem/engine.hpp"

namespace grainsweep::observables {

/// Returns the solid fraction of settled powder in a vessel of this cross-section. It is measured between z = bottom +
/// 3 D and 3 D below the 95 % quantile of the centres' heights; NaN if the powder is lower.
[[nodiscard]] double settled_fraction(const dem::State& state, double bottom, double diameter, double section);

}  // namespace grainsweep::observables
