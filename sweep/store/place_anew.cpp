// Places of a campaign that cannot simply be extended: a design with renumbered points replaces the old one, and a
// damaged design is repaired.
#include "sweep/campaign/input_error.hpp"
#include "sweep/store/archive.hpp"
#include "sweep/store/soundness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <unordered_set>

namespace grainsweep::store {

namespace {

using campaign::Campaign;

struct Place {
    std::int64_t point = 0, replicate = 0, sequence = 0, case_key = 0;
};

bool before(const Place& a, const Place& b) {
    return std::pair(a.point, a.replicate) < std::pair(b.point, b.replicate);
}

std::vector<Place> stored_places(const Connection& db, std::int64_t campaign_key) {
    std::vector<Place> places;
    auto rows = db.ask(
        "SELECT point, replicate, sequence, case_key FROM campaign_case WHERE campaign_id = ? "
        "ORDER BY point, replicate",
        campaign_key);
    while (rows.next()) {
        places.push_back({rows.get<std::int64_t>(0), rows.get<std::int64_t>(1), rows.get<std::int64_t>(2),
                          rows.get<std::int64_t>(3)});
    }
    return places;
}

/// Places of the campaign, every one of its cases entered, in their order.
std::vector<Place> asked_places(const campaign::Cases& cases, const Placing& placing) {
    std::vector<Place> places;
    places.reserve(cases.size());
    for (std::size_t i = 0; i < cases.size(); ++i) {
        const auto& [point, sequence, replicate] = cases.place(i);
        places.push_back({point, replicate, sequence, placing.key(i)});
    }
    std::ranges::sort(places, before);
    return places;
}

RowSum sum_of(std::span<const Place> places) {
    RowSum sum;
    for (const auto& it : places) sum.add(checksum_of_place(it.point, it.replicate, it.sequence, it.case_key));
    return sum;
}

/// Asked places that are not stored, up to the first that stands for another case.
struct Difference {
    std::vector<Place> fresh;
    const Place* moved = nullptr;  ///< of `asked`
};

Difference difference(const std::vector<Place>& stored, const std::vector<Place>& asked) {
    Difference found;
    auto old = stored.begin();
    for (const auto& it : asked) {
        while (old != stored.end() && before(*old, it)) ++old;
        if (old == stored.end() || before(it, *old)) {
            found.fresh.push_back(it);
        } else if (old->case_key != it.case_key) {
            found.moved = &it;
            break;
        }
    }
    return found;
}

/// A damaged design is put right by the whole of it.
void refuse_a_part(const Store::Impl& archive, const Campaign& campaign, std::int64_t written, std::size_t asked) {
    if (static_cast<std::int64_t>(asked) >= written) return;
    throw SystemError(
        fmt::format("database '{}': damaged: the design of campaign '{}' is not as written. A run of the whole "
                    "campaign, {} cases, puts it right; this one asks for {}",
                    archive.file.string(), campaign.name, written, asked));
}

/// Refuses changes by which a stored case would leave the campaign's view. A list grows only at its end.
void refuse_a_loss(const Store::Impl& archive, const Campaign& campaign, const std::vector<Place>& stored,
                   const std::vector<Place>& asked, const Place& moved) {
    const auto& design = designs::design_named(campaign.design);
    if (design.beginning == designs::Beginning::listed) {
        throw campaign::input_error(
            "$.design.rows", fmt::format("another row {}", moved.point),
            fmt::format("campaign '{}' stands in '{}' with its own: a list is extended at its end", campaign.name,
                        archive.file.string()));
    }
    std::unordered_set<std::int64_t> kept;
    for (const auto& it : asked) kept.insert(it.case_key);
    if (std::ranges::all_of(stored, [&](const Place& it) { return kept.contains(it.case_key); })) return;
    throw campaign::input_error(
        "$.design", fmt::format("{} cases", asked.size()),
        fmt::format("campaign '{}' stands in '{}' with {}, and this {} does not contain them all: ask for no fewer "
                    "replicates, or give another question another name",
                    campaign.name, archive.file.string(), stored.size(), campaign.design));
}

void enter(Connection& db, std::int64_t campaign_key, const std::vector<Place>& places) {
    for (const auto& it : places) {
        db.run("INSERT INTO campaign_case (campaign_id, point, replicate, sequence, case_key) VALUES (?, ?, ?, ?, ?)",
               campaign_key, it.point, it.replicate, it.sequence, it.case_key);
    }
}

}  // namespace

void forget_convergence(Connection& db, std::int64_t campaign_key) {
    db.run("DELETE FROM convergence WHERE campaign_id = ?", campaign_key);
    store_sum(db, "convergence", campaign_key, {});
    db.run("UPDATE campaign SET stopped_at = NULL WHERE campaign_id = ?", campaign_key);
}

void place_anew(Store::Impl& archive, const Campaign& campaign, std::int64_t campaign_key, const campaign::Cases& cases,
                const Placing& placing) {
    auto& db = archive.db;
    const auto asked = asked_places(cases, placing);
    const auto stored = stored_places(db, campaign_key);
    const RowSum written = stored_sum(db, "campaign_case", campaign_key);
    const auto [fresh, moved] = difference(stored, asked);

    const bool damaged = sum_of(stored) != written;
    if (damaged) {
        refuse_a_part(archive, campaign, written.rows, asked.size());
        archive.notes.push_back("the design was damaged in the database and is put right");
    } else if (moved != nullptr) {
        refuse_a_loss(archive, campaign, stored, asked, *moved);
    }
    if (damaged || moved != nullptr) {
        db.run("DELETE FROM campaign_case WHERE campaign_id = ?", campaign_key);
        enter(db, campaign_key, asked);
        store_sum(db, "campaign_case", campaign_key, sum_of(asked));
    } else if (!fresh.empty()) {
        enter(db, campaign_key, fresh);
        RowSum sum = written;
        sum.add(sum_of(fresh));
        store_sum(db, "campaign_case", campaign_key, sum);
    }
    const auto& entered = damaged ? asked : fresh;
    const bool inside = !stored.empty() && !entered.empty() && entered.front().point <= stored.back().point;
    if ((!damaged && moved != nullptr) || inside) forget_convergence(db, campaign_key);
}

}  // namespace grainsweep::store
