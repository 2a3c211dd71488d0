// The identity of a stored campaign: as JSON or, in an older database, as texts. And its extent.
#include "sweep/campaign/stored_identity.hpp"
#include "sweep/store/archive.hpp"
#include "sweep/store/database_errors.hpp"

#include <fmt/format.h>

#include <exception>

namespace grainsweep::store {

namespace {

constexpr std::string_view resolved_sum = "campaign.resolved";

bool has_resolved(const Connection& db) {
    return has_column(db, "campaign", "resolved");
}

/// Returns the JSON; empty if it cannot be read back.
std::optional<std::string> readable_json(const campaign::Identity& identity) {
    try {
        auto text = campaign::resolved_text(identity);
        (void)campaign::read_resolved(text);
        return text;
    } catch (const std::exception&) {  // texts of an older program that accepted other values
        return std::nullopt;
    }
}

}  // namespace

std::string identity_columns(const Connection& db) {
    return fmt::format(
        "name, scene, revision, seed, factors, fixed, condition, design, design_options, design_extent, {}",
        has_resolved(db) ? "resolved" : "NULL");
}

campaign::Identity identity_at(const Rows& rows, int first) {
    if (const int resolved = first + identity_column_count - 1; !rows.is_null(resolved)) try {
            return campaign::read_resolved(rows.get<std::string_view>(resolved));
        } catch (const std::exception& refused) {
            throw SystemError(fmt::format("damaged: campaign '{}' is not as written: {}",
                                          rows.get<std::string_view>(first), refused.what()));
        }
    campaign::Identity identity{.name = rows.get<std::string>(first),
                                .scene = rows.get<std::string>(first + 1),
                                .revision = rows.get<std::int64_t>(first + 2),
                                .seed = static_cast<std::uint64_t>(rows.get<std::int64_t>(first + 3)),
                                .condition = rows.get<std::string>(first + 6),
                                .design = rows.get<std::string>(first + 7)};
    campaign::read_texts(identity, {.factors = rows.get<std::string>(first + 4),
                                    .fixed = rows.get<std::string>(first + 5),
                                    .options = rows.get<std::string>(first + 8),
                                    .extent = rows.get<std::string>(first + 9)});
    return identity;
}

void store_identity(Connection& db, std::int64_t campaign_key, const campaign::Identity& identity) {
    const auto texts = campaign::texts_of(identity);
    db.run(
        "UPDATE campaign SET factors = ?1, design_options = ?2, design_extent = ?3, resolved = ?4 WHERE campaign_id = "
        "?5",
        texts.factors, texts.options, texts.extent, readable_json(identity), campaign_key);
}

void resolve_campaigns(Connection& db) {
    std::vector<std::pair<std::int64_t, campaign::Identity>> all;
    {
        auto rows = db.ask(fmt::format("SELECT campaign_id, {} FROM campaign", identity_columns(db)));
        while (rows.next()) all.emplace_back(rows.get<std::int64_t>(0), identity_at(rows, 1));
    }
    for (const auto& [key, identity] : all)
        db.run("UPDATE campaign SET resolved = ? WHERE campaign_id = ?", readable_json(identity), key);
    renew_sum(db, resolved_sum);
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
    auto rows = db.ask(fmt::format("SELECT campaign_id, {} FROM campaign WHERE name = ?", identity_columns(db)), name);
    if (!rows.next()) return std::nullopt;
    return KnownCampaign{rows.get<std::int64_t>(0), identity_at(rows, 1)};
}

std::optional<KnownCampaign> match_campaign(const Store::Impl& archive, const campaign::Campaign& campaign) {
    auto known = known_campaign(archive.db, campaign.name);
    if (known) campaign::require_same(known->identity, campaign::identity_of(campaign), archive.file.string());
    return known;
}

}  // namespace grainsweep::store
