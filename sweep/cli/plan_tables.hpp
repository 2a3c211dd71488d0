// Tables of `plan`: factors, and distributions of factors.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/store/store.hpp"

namespace grainsweep::cli {

[[nodiscard]] store::Table factors_of(const campaign::Campaign& campaign);

/// Returns, for factors with a distribution, quantiles, the density as a row of characters along the range, and the
/// share cut off by the bounds of the parameter; no rows if there are none.
[[nodiscard]] store::Table distributions_of(const campaign::Campaign& campaign);

}  // namespace grainsweep::cli
