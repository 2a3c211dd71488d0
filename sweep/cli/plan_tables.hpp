// Tables of `plan`: factors, and distributions of factors.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/store/store.hpp"

namespace grainsweep::cli {

[[nodiscard]] store::Table factors_of(const campaign::Campaign& campaign);

/// Returns one row for each factor with a distribution: quantiles, the density as a row of characters along the range,
/// and the share outside the bounds of the parameter.
[[nodiscard]] store::Table distributions_of(const campaign::Campaign& campaign);

}  // namespace grainsweep::cli
