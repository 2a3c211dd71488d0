// Designs that grow: the stored answers of a campaign decide its next points.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/store/store.hpp"

#include <span>
#include <string>

namespace grainsweep::schedule {

/// Adds the stored answers of the campaign's points to its design request. Returns whether the design then has more
/// points than before. Does nothing for a design that does not grow, and for a campaign that is not stored.
///
/// For a design that calibrates, adds the campaign's `where` clause, too: excluded points are no failures.
///
/// Points settled without an answer: cases that crashed or timed out in all their attempts, unstable and rejected
/// cases, cases whose observable is undefined, and points that the `where` clause excludes. Throws InputError where
/// another campaign is stored under the name.
bool grow(campaign::Campaign& campaign, const store::Store& store);

using Answers = decltype(designs::DesignRequest::answers);
/// Returns the stored answers of a campaign's points, for these scalars or places along curves. "heap/angle" is the
/// observable `angle` of the campaign that runs the experiment "heap" of the same calibration.
[[nodiscard]] Answers known_answers(const store::Store& store, const store::CampaignRecord& record,
                                    std::span<const std::string> observables);

/// Adds what a calibration needs of a stored campaign to its design request: the answers of its points, and which
/// points its `where` clause accepts.
void learn_answers(designs::DesignRequest& request, const store::Store& store, const store::CampaignRecord& record);

}  // namespace grainsweep::schedule
