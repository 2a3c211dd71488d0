// Judge of a running campaign.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/schedule/judge.hpp"
#include "sweep/store/store.hpp"

#include <cstdint>
#include <memory>

namespace grainsweep::cli {

/// Returns the judge of the campaign's rule, with the stored values; nullptr without a rule. `placed`: every stored
/// place.
[[nodiscard]] std::unique_ptr<schedule::Judge> make_judge(const campaign::Campaign& campaign, const store::Store& store,
                                                          const campaign::Cases& placed, std::int64_t candidates);

}  // namespace grainsweep::cli
