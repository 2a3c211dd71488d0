#include "sweep/schedule/growth.hpp"

#include <limits>
#include <optional>
#include <vector>

namespace grainsweep::schedule {

std::vector<std::optional<double>> known_answers(const store::Store& store, const store::CampaignRecord& record,
                                                 std::string_view observable) {
    std::vector<std::optional<double>> answers(static_cast<std::size_t>(record.stored.candidates),
                                               std::numeric_limits<double>::quiet_NaN());
    for (const auto& it : store.values(record.name, observable)) {
        const bool settled = it.outcome && *it.outcome != campaign::Outcome::abandoned;
        answers[static_cast<std::size_t>(it.point)] = settled ? std::optional(it.value) : std::nullopt;
    }
    return answers;
}

bool grow(campaign::Campaign& campaign, const store::Store& store) {
    const auto& design = designs::design_named(campaign.design);
    if (!design.grows) return false;
    const auto record = store.stored(campaign);
    if (!record) return false;
    const auto before = design.size(campaign.request);
    campaign.request.answers = known_answers(store, *record, campaign.request.word("observable"));
    return design.size(campaign.request) > before;
}

}  // namespace grainsweep::schedule
