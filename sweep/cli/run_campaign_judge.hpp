// The judge of a campaign that runs.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/schedule/judge.hpp"
#include "sweep/store/store.hpp"

#include <cstdint>
#include <memory>

namespace grainsweep::cli {

/// Makes the judge of the campaign's rule, with the values that the archive has; none where it gives no rule. `placed`:
/// every place that is stored.
[[nodiscard]] std::unique_ptr<schedule::Judge> make_judge(const campaign::Campaign& campaign, const store::Store& store,
                                                          const campaign::Cases& placed, std::int64_t candidates);

}  // namespace grainsweep::cli
