// Designs that grow: what the archive knows of a campaign's points decides which come next.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/store/store.hpp"

#include <span>
#include <string>

namespace grainsweep::schedule {

/// Puts what `store` knows of the campaign's points into its request, and says whether that brings points beyond those
/// there were. Does nothing for a design that does not grow, and for a campaign that is not stored.
///
/// Settled without an answer are: cases that crashed or ran out of time as often as allowed, unstable and rejected
/// cases, cases whose observable is undefined, and points that the `where` clause leaves out. Throws WrongQuestion
/// where another campaign is stored under the name.
bool grow(campaign::Campaign& campaign, const store::Store& store);

using Answers = decltype(designs::DesignRequest::answers);
/// What is known of the points of a stored campaign, of these scalars or places along curves; "heap/angle" is that of
/// the campaign that runs the experiment "heap" of the same calibration.
[[nodiscard]] Answers known_answers(const store::Store& store, const store::CampaignRecord& record,
                                    std::span<const std::string> observables);

}  // namespace grainsweep::schedule
