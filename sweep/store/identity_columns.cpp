// The identity of a stored campaign: kept as campaign/identity wrote it, handed back as it is. And its extent.
#include "sweep/store/archive.hpp"

#include <fmt/format.h>

namespace grainsweep::store {

campaign::Identity identity_at(const Rows& rows, int first) {
    campaign::Identity identity;
    identity.name = rows.get<std::string>(first);
    identity.scene = rows.get<std::string>(first + 1);
    identity.revision = rows.get<std::int64_t>(first + 2);
    identity.seed = static_cast<std::uint64_t>(rows.get<std::int64_t>(first + 3));
    identity.factors = rows.get<std::string>(first + 4);
    identity.fixed = rows.get<std::string>(first + 5);
    identity.condition = rows.get<std::string>(first + 6);
    identity.design = rows.get<std::string>(first + 7);
    identity.options = rows.get<std::string>(first + 8);
    identity.extent = rows.get<std::string>(first + 9);
    return identity;
}

std::string extent_columns(bool kept) {
    constexpr std::string_view placed =
        "(SELECT max(point) + 1 FROM campaign_case AS e WHERE e.campaign_id = g.campaign_id)";
    if (!kept) return fmt::format("{0}, {0}, g.replicates", placed);
    return fmt::format(
        "coalesce(g.candidates, {0}), coalesce(g.asked_candidates, {0}), coalesce(g.asked_replicates, g.replicates)",
        placed);
}

std::optional<KnownCampaign> known_campaign(const Connection& db, std::string_view name) {
    auto rows = db.ask(fmt::format("SELECT campaign_id, {} FROM campaign WHERE name = ?", identity_columns), name);
    if (!rows.next()) return std::nullopt;
    return KnownCampaign{rows.get<std::int64_t>(0), identity_at(rows, 1)};
}

std::optional<std::int64_t> match_campaign(const Store::Impl& archive, const campaign::Campaign& campaign) {
    const auto known = known_campaign(archive.db, campaign.name);
    if (!known) return std::nullopt;
    campaign::require_same(known->identity, campaign::identity_of(campaign), archive.file.string());
    return known->key;
}

}  // namespace grainsweep::store
