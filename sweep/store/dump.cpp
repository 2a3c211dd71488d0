// Database as canonical text. Two databases with the same answers give the same lines, independent of the order of
// completion, the attempts, the machine and the time.
//
//     case ID scene=NAME revision=N seed=N outcome=WORD
//       NAME = VALUE                      inputs that differ from the scene's defaults
//       message TEXT                      why: skipped, unstable, rejected (a crash is of the machine); where an
//                                         adopted answer comes from
//       scalar NAME = VALUE
//       series NAME K time bin value      "-" where undefined
//     campaign NAME scene=NAME revision=N seed=N design=KIND [stopped_at=N]
//       POINT REPLICATE SEQUENCE ID       its design
//       convergence OBSERVABLE POINTS ...
//
// Cases in order of their id, everything else in order of name or number, doubles in shortest round-trip form.
// Only cases that count in a campaign are included. Answers beyond the point of convergence, and answers that no
// present design contains, are in the database but not in this text.
#include "sweep/campaign/visible_text.hpp"
#include "sweep/store/archive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

namespace grainsweep::store {

namespace {

using Sink = std::function<void(std::string_view line)>;

std::string number_text(double x) {
    return std::isnan(x) ? "-" : campaign::shortest(x);
}

/// One line whatever the text holds.
std::string escaped(std::string_view text) {
    std::string line;
    for (const char c : text) {
        if (c == '\n') {
            line += "\\n";
        } else if (c == '\\') {
            line += "\\\\";
        } else {
            line += c;
        }
    }
    return campaign::visible(line);
}

void dump_inputs(const Connection& db, std::int64_t key, const Sink& sink) {
    auto rows = db.ask(
        "SELECT q.name, i.value FROM case_input AS i JOIN parameter AS q ON q.parameter_id = i.parameter_id "
        "WHERE i.case_key = ? ORDER BY q.name",
        key);
    while (rows.next())
        sink(fmt::format("  {} = {}", rows.get<std::string_view>(0), escaped(campaign::identity_text(rows.value(1)))));
}

void dump_observations(const Connection& db, std::int64_t key, const Sink& sink) {
    auto rows = db.ask(
        "SELECT b.name, b.shape, o.sample, o.time, o.bin, o.value FROM observation AS o "
        "JOIN observable AS b ON b.observable_id = o.observable_id WHERE o.case_key = ? "
        "ORDER BY b.shape <> 'scalar', b.name, o.sample",
        key);
    while (rows.next()) {
        const auto name = rows.get<std::string_view>(0);
        if (rows.get<std::string_view>(1) == "scalar") {
            sink(fmt::format("  scalar {} = {}", name, number_text(rows.get<double>(5))));
        } else {
            sink(fmt::format("  series {} {} {} {} {}", name, rows.get<std::int64_t>(2),
                             number_text(rows.get<double>(3)), number_text(rows.get<double>(4)),
                             number_text(rows.get<double>(5))));
        }
    }
}

/// The cases that a campaign counts, ascending.
std::vector<std::int64_t> counted_cases(const Connection& db) {
    std::map<std::int64_t, std::optional<std::int64_t>> stops;
    {
        auto rows = db.ask("SELECT campaign_id, stopped_at FROM campaign NOT INDEXED");
        while (rows.next()) stops.emplace(rows.get<std::int64_t>(0), rows.get<std::optional<std::int64_t>>(1));
    }
    std::vector<std::int64_t> keys;
    auto rows = db.ask("SELECT campaign_id, point, sequence, case_key FROM campaign_case NOT INDEXED");
    while (rows.next()) {
        const auto campaign = stops.find(rows.get<std::int64_t>(0));
        if (campaign == stops.end()) continue;
        if (!campaign->second || rows.get<std::int64_t>(1) < *campaign->second)
            keys.push_back(rows.get<std::int64_t>(3));
    }
    std::ranges::sort(keys);
    return keys;
}

/// Only tables have checksums, and a damaged index could hide a case. So indices are not used: NOT INDEXED, + before
/// the columns of ORDER BY, all columns selected.
void dump_cases(const Connection& db, const Sink& sink) {
    const auto counted = counted_cases(db);
    auto rows = db.ask(
        "SELECT case_key, case_id, scene, revision, seed, outcome, CASE WHEN outcome IN ('completed', 'skipped', "
        "'unstable', 'rejected') "
        "THEN (SELECT message FROM attempt AS t WHERE t.case_key = c.case_key AND t.outcome = c.outcome "
        "ORDER BY number DESC LIMIT 1) END FROM sim_case AS c NOT INDEXED WHERE outcome <> 'abandoned' "
        "ORDER BY +case_id");
    while (rows.next()) {
        const auto key = rows.get<std::int64_t>(0);
        if (!std::ranges::binary_search(counted, key)) continue;
        sink(fmt::format("case {} scene={} revision={} seed={} outcome={}", rows.get<std::string_view>(1),
                         rows.get<std::string_view>(2), rows.get<std::int64_t>(3), rows.get<std::int64_t>(4),
                         rows.get<std::string_view>(5)));
        dump_inputs(db, key, sink);
        if (!rows.is_null(6)) sink(fmt::format("  message {}", escaped(rows.get<std::string_view>(6))));
        dump_observations(db, key, sink);
    }
}

void dump_convergence(const Connection& db, std::int64_t campaign, std::optional<std::int64_t> stopped_at,
                      const Sink& sink) {
    auto rows = db.ask(
        "SELECT observable, points, excluded, converged, mean, sd, skewness, g1, kurtosis, mean_error, sd_error, "
        "skewness_error, g1_error, kurtosis_error, zero_share FROM convergence WHERE campaign_id = ? "
        "AND (?2 IS NULL OR points <= ?2) ORDER BY observable, points",
        campaign, stopped_at);
    while (rows.next()) {
        std::string line = fmt::format("  convergence {} {} excluded={} converged={}", rows.get<std::string_view>(0),
                                       rows.get<std::int64_t>(1), rows.get<std::int64_t>(2), rows.get<std::int64_t>(3));
        for (int column = 4; column < 15; ++column) line += ' ' + number_text(rows.get<double>(column));
        sink(line);
    }
}

void dump_campaigns(const Connection& db, const Sink& sink) {
    auto campaigns = db.ask(
        "SELECT campaign_id, name, scene, revision, seed, design, stopped_at FROM campaign NOT INDEXED ORDER BY name");
    while (campaigns.next()) {
        const auto key = campaigns.get<std::int64_t>(0);
        const auto stopped_at = campaigns.get<std::optional<std::int64_t>>(6);
        sink(fmt::format("campaign {} scene={} revision={} seed={} design={}{}", campaigns.get<std::string_view>(1),
                         campaigns.get<std::string_view>(2), campaigns.get<std::int64_t>(3),
                         static_cast<std::uint64_t>(campaigns.get<std::int64_t>(4)), campaigns.get<std::string_view>(5),
                         stopped_at ? fmt::format(" stopped_at={}", *stopped_at) : ""));
        auto places = db.ask(
            "SELECT point, replicate, sequence, case_id FROM campaign_case AS p NOT INDEXED JOIN sim_case AS c NOT "
            "INDEXED ON c.case_key = p.case_key "
            "WHERE p.campaign_id = ?1 AND (?2 IS NULL OR point < ?2) ORDER BY point, replicate",
            key, stopped_at);
        while (places.next()) {
            sink(fmt::format("  {} {} {} {}", places.get<std::int64_t>(0), places.get<std::int64_t>(1),
                             places.get<std::int64_t>(2), places.get<std::string_view>(3)));
        }
        dump_convergence(db, key, stopped_at, sink);
    }
}

}  // namespace

void Store::dump(const Sink& sink) const {
    const Transaction one_state(impl_->db, Transaction::Kind::read);
    impl_->require_sound();
    dump_cases(impl_->db, sink);
    dump_campaigns(impl_->db, sink);
}

}  // namespace grainsweep::store
