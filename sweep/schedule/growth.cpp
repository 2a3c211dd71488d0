#include "sweep/schedule/growth.hpp"

#include "sweep/campaign/experiments.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/stored_request.hpp"
#include "sweep/store/expression.hpp"

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

namespace {

/// Which points the `where` clause of a stored campaign accepts; empty: all, or an older version accepted a clause that
/// is refused now.
std::function<bool(std::span<const double>)> admission(const store::CampaignRecord& record) {
    if (record.condition.empty()) return {};
    auto space = campaign::space_of(record);
    if (!space) return {};
    std::vector<std::string> names;
    for (const auto& [name, value] : space->scene->defaults()) names.push_back(name);
    try {
        return [space = std::move(*space), filter = store::make_filter(record.condition, names)](
                   std::span<const double> u) { return filter(space.at(u)); };
    } catch (const campaign::InputError&) {
        return {};
    }
}

}  // namespace

void learn_answers(designs::DesignRequest& request, const store::Store& store, const store::CampaignRecord& record) {
    const auto& design = designs::design_named(record.design);
    request.answers = known_answers(store, record, design.rests_on(request));
    if (design.calibrates) request.admits = admission(record);
}

bool grow(campaign::Campaign& campaign, const store::Store& store) {
    const auto& design = designs::design_named(campaign.design);
    if (!design.grows) return false;
    const auto record = store.stored(campaign);
    if (!record) return false;
    const auto before = design.size(campaign.request);
    campaign.request.grown.reset();
    learn_answers(campaign.request, store, *record);
    campaign.request.grown = std::make_shared<const designs::PointSet>(design.sample(campaign.request));
    return design.size(campaign.request) > before;
}

}  // namespace grainsweep::schedule
