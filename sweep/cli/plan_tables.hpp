// Tables of `plan`: the factors, and those that follow a distribution.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/store/store.hpp"

namespace grainsweep::cli {

[[nodiscard]] store::Table factors_of(const campaign::Campaign& campaign);

/// Quantiles of the factors that follow a distribution, its density as a row of signs over the range, and what the
/// bounds of the parameter cut off; no rows where none does.
[[nodiscard]] store::Table distributions_of(const campaign::Campaign& campaign);

}  // namespace grainsweep::cli
