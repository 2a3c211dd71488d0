#include "sweep/schedule/growth.hpp"

#include "sweep/campaign/experiments.hpp"

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>

namespace grainsweep::schedule {

Answers known_answers(const store::Store& store, const store::CampaignRecord& record,
                      std::span<const std::string> observables) {
    Answers answers;
    std::vector<store::CampaignRecord> others;
    for (const auto& key : observables) {
        const auto slash = key.find('/');
        const store::CampaignRecord* asked = &record;
        if (slash != std::string::npos) {
            if (others.empty()) others = store.campaigns();
            const auto found = std::ranges::find(others, campaign::name_beside(record, key.substr(0, slash)),
                                                 &store::CampaignRecord::name);
            if (found == others.end()) continue;
            asked = &*found;
        }
        auto& known = answers[key];
        known.assign(static_cast<std::size_t>(asked->stored.candidates), std::numeric_limits<double>::quiet_NaN());
        const auto [name, at] = designs::place_on_curve(slash == std::string::npos ? key : key.substr(slash + 1));
        const auto values = at ? store.values_along(asked->name, name, *at) : store.values(asked->name, name);
        for (const auto& it : values) {
            const bool settled = it.outcome && *it.outcome != campaign::Outcome::abandoned;
            known[static_cast<std::size_t>(it.point)] = settled ? std::optional(it.value) : std::nullopt;
        }
    }
    return answers;
}

bool grow(campaign::Campaign& campaign, const store::Store& store) {
    const auto& design = designs::design_named(campaign.design);
    if (!design.grows) return false;
    const auto record = store.stored(campaign);
    if (!record) return false;
    const auto before = design.size(campaign.request);
    campaign.request.grown.reset();
    campaign.request.answers = known_answers(store, *record, design.rests_on(campaign.request));
    campaign.request.grown = std::make_shared<const designs::PointSet>(design.sample(campaign.request));
    return design.size(campaign.request) > before;
}

}  // namespace grainsweep::schedule
