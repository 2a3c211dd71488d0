// Queries of the archive by the scheduler, the statistics and the commands.
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/plain_name.hpp"
#include "sweep/campaign/stored_text.hpp"
#include "sweep/store/archive.hpp"
#include "sweep/store/soundness.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace grainsweep::store {

using campaign::Outcome;

namespace {

std::vector<std::string> words_of(std::string_view text) {
    std::vector<std::string> words;
    std::istringstream stream{std::string(text)};
    for (std::string word; stream >> word;) words.push_back(word);
    return words;
}

std::optional<campaign::Convergence> rule_at(const Rows& rows, int first) {
    if (rows.is_null(first)) return std::nullopt;
    campaign::Convergence rule;
    rule.observable = rows.get<std::string>(first);
    rule.rule = rows.get<std::string>(first + 1);
    rule.gates = words_of(rows.get<std::string_view>(first + 2));
    rule.tolerance = rows.get<double>(first + 3);
    rule.block = rows.get<std::int64_t>(first + 4);
    rule.stop = rows.get<std::int64_t>(first + 5) != 0;
    return rule;
}

std::optional<std::int64_t> case_key(const Connection& db, std::string_view case_id) {
    return db.value<std::int64_t>("SELECT case_key FROM sim_case WHERE case_id = ?", case_id);
}

/// Reads the tables, not the view `inputs`, because a database may have another view of this name.
Inputs inputs_of(const Connection& db, std::string_view case_id) {
    Inputs inputs;
    auto rows = db.ask(
        "SELECT q.name, coalesce(i.value, q.default_value) FROM sim_case AS c JOIN parameter AS q ON q.scene = c.scene "
        "AND q.revision = c.revision LEFT JOIN case_input AS i ON i.case_key = c.case_key AND i.parameter_id = "
        "q.parameter_id WHERE c.case_id = ?",
        case_id);
    while (rows.next()) inputs.emplace(rows.get<std::string>(0), rows.value(1));
    return inputs;
}

Observations observations_of(const Connection& db, std::int64_t key) {
    Observations observations;
    auto rows = db.ask(
        "SELECT b.name, b.shape, o.time, o.bin, o.value FROM observation AS o "
        "JOIN observable AS b ON b.observable_id = o.observable_id "
        "WHERE o.case_key = ? ORDER BY o.observable_id, o.sample",
        key);
    while (rows.next()) {
        auto name = rows.get<std::string>(0);
        if (rows.get<std::string_view>(1) == "scalar") {
            observations.scalars.emplace(std::move(name), rows.get<double>(4));
        } else {
            observations.series[std::move(name)].push_back(
                {.time = rows.get<double>(2), .bin = rows.get<double>(3), .value = rows.get<double>(4)});
        }
    }
    return observations;
}

}  // namespace

std::int64_t Store::Impl::campaign_key(std::string_view name) const {
    if (const auto key = db.value<std::int64_t>("SELECT campaign_id FROM campaign WHERE name = ?", name)) return *key;
    const auto names = db.column<std::string>("SELECT name FROM campaign ORDER BY campaign_id");
    throw campaign::input_error("campaign", name, fmt::format("'{}' holds {}", file.string(), campaign::listed(names)),
                                campaign::nearest_word(name, names));
}

bool Store::Impl::keeps_extents() const {
    return has_column(db, "campaign", "candidates");
}

std::vector<CampaignRecord> Store::campaigns() const {
    impl_->require_sound();
    const auto imported = imported_campaigns(impl_->db);
    std::vector<CampaignRecord> records;
    auto rows = impl_->db.ask(fmt::format(
        "SELECT {}, coalesce((SELECT campaign_text FROM provenance AS v WHERE v.campaign_id = g.campaign_id "
        "ORDER BY provenance_id DESC LIMIT 1), ''), sequences, replicates, stopped_at, convergence_observable, "
        "convergence_rule, convergence_gates, convergence_tolerance, convergence_block, convergence_stop, {}, "
        "campaign_id "
        "FROM campaign AS g ORDER BY campaign_id",
        identity_columns(impl_->db), extent_columns(impl_->keeps_extents())));
    while (rows.next()) {
        CampaignRecord record;
        static_cast<campaign::Identity&>(record) = identity_at(rows, 0);
        int column = identity_column_count;
        record.text = rows.get<std::string>(column++);
        record.sequences = rows.get<std::int64_t>(column++);
        record.replicates = rows.get<std::int64_t>(column++);
        record.stopped_at = rows.get<std::optional<std::int64_t>>(column++);
        record.convergence = rule_at(rows, column);
        column += 6;
        record.stored = {rows.get<std::int64_t>(column), record.replicates};
        record.asked = {rows.get<std::int64_t>(column + 1), rows.get<std::int64_t>(column + 2)};
        if (const auto into = imported.find(rows.get<std::int64_t>(column + 3)); into != imported.end())
            record.imported_into = into->second;
        records.push_back(std::move(record));
    }
    return records;
}

std::vector<std::string> Store::factor_order(std::string_view name) const {
    const auto known = known_campaign(impl_->db, name);
    std::vector<std::string> names;
    if (known)
        for (const auto& factor : known->identity.factors) names.push_back(factor.name);
    return names;
}

std::optional<CampaignRecord> Store::stored(const campaign::Campaign& campaign) const {
    if (!match_campaign(*impl_, campaign)) return std::nullopt;
    auto records = campaigns();
    const auto found = std::ranges::find(records, campaign.name, &CampaignRecord::name);
    return found == records.end() ? std::nullopt : std::optional(std::move(*found));
}

std::int64_t Store::settled(const campaign::Cases& cases) const {
    const auto known = known_cases(impl_->db, cases);
    return std::ranges::count_if(known.states,
                                 [](const CaseState& state) { return state.outcome && settles(*state.outcome); });
}

bool Store::is_settled(std::string_view case_id) const {
    auto rows = impl_->db.ask("SELECT outcome FROM sim_case WHERE case_id = ?", case_id);
    if (!rows.next()) return false;
    const auto outcome = outcome_at(rows, 0);
    return outcome && settles(*outcome);
}

StoredPlaces Store::placement(std::string_view campaign) const {
    impl_->require_sound();
    StoredPlaces stored;
    auto rows = impl_->db.ask(
        "SELECT p.point, p.sequence, p.replicate, c.case_id, c.attempts, c.failures, c.outcome FROM campaign_case AS p "
        "JOIN sim_case AS c ON c.case_key = p.case_key WHERE p.campaign_id = ? ORDER BY p.point, p.replicate",
        impl_->campaign_key(campaign));
    const auto small = [&](int column) { return static_cast<std::uint32_t>(rows.get<std::int64_t>(column)); };
    while (rows.next()) {
        stored.places.push_back({small(0), small(1), small(2)});
        stored.hashes.push_back(campaign::hash_of(rows.get<std::string_view>(3)));
        stored.states.push_back({static_cast<std::int32_t>(rows.get<std::int64_t>(4)),
                                 static_cast<std::int32_t>(rows.get<std::int64_t>(5)), outcome_at(rows, 6)});
    }
    return stored;
}

std::optional<campaign::Case> Store::find_case(std::string_view id_or_prefix) const {
    const std::string prefix = campaign::small_letters(id_or_prefix);
    const std::string end = prefix + "g";  // above every hexadecimal digit
    std::vector<campaign::Case> found;
    {
        auto rows = impl_->db.ask(
            "SELECT case_id, scene, revision, seed FROM sim_case WHERE case_id >= ? AND case_id < ? LIMIT 2", prefix,
            end);
        while (rows.next()) {
            found.push_back({rows.get<std::string>(0),
                             rows.get<std::string>(1),
                             static_cast<int>(rows.get<std::int64_t>(2)),
                             {},
                             static_cast<std::uint64_t>(rows.get<std::int64_t>(3))});
        }
    }
    if (found.empty()) return std::nullopt;
    if (found.size() > 1) {
        throw campaign::input_error(
            "case", id_or_prefix,
            fmt::format("several cases begin so, {} and {} among them; give more digits", found[0].id, found[1].id));
    }
    if (const auto key = case_key(impl_->db, found.front().id)) impl_->require_sound(*key);
    found.front().inputs = inputs_of(impl_->db, found.front().id);
    return std::move(found.front());
}

namespace {

/// What computed an attempt; an archive of an older form knows only what ran the campaign, and not how many threads.
std::string attempts_question(const Connection& db) {
    const bool computers = has_table(db, "attempt_computer");
    return fmt::format(
        "SELECT number, outcome, coalesce(message, ''), wall_seconds, started, version, \"commit\", {}, "
        "instruction_path, processor, host, {} FROM attempt AS t JOIN {} WHERE case_key = ? ORDER BY number",
        computers ? "build" : "''", has_threads(db) ? "threads" : "NULL",
        computers ? "attempt_computer AS m ON m.computer_id = t.computer_id"
                  : "provenance AS v ON v.provenance_id = t.provenance_id");
}

}  // namespace

std::vector<LoggedAttempt> Store::attempts(std::string_view case_id) const {
    std::vector<LoggedAttempt> attempts;
    const auto key = case_key(impl_->db, case_id);
    if (!key) return attempts;
    auto rows = impl_->db.ask(attempts_question(impl_->db), *key);
    while (rows.next()) {
        attempts.push_back({.number = rows.get<std::int64_t>(0),
                            .outcome = outcome_at(rows, 1),
                            .message = rows.get<std::string>(2),
                            .wall_seconds = rows.get<double>(3),
                            .started = rows.get<std::string>(4),
                            .computer = {rows.get<std::string>(5), rows.get<std::string>(6), rows.get<std::string>(7),
                                         rows.get<std::string>(8), rows.get<std::string>(9), rows.get<std::string>(10)},
                            .threads = rows.get<double>(11)});
    }
    for (auto& [number, facts] : program_facts(impl_->db, *key)) {
        const auto attempt = std::ranges::find(attempts, number, &LoggedAttempt::number);
        if (attempt != attempts.end()) attempt->program = std::move(facts);
    }
    for (auto& [number, line] : imported_lines(impl_->db, *key)) {
        const auto attempt = std::ranges::find(attempts, number, &LoggedAttempt::number);
        if (attempt != attempts.end()) attempt->imported = std::move(line);
    }
    return attempts;
}

std::vector<CasePlace> Store::places(std::string_view case_id) const {
    std::vector<CasePlace> places;
    const auto key = case_key(impl_->db, case_id);
    if (!key) return places;
    auto rows = impl_->db.ask(
        "SELECT g.name, p.point, g.stopped_at, (SELECT v.campaign_text FROM provenance AS v "
        "WHERE v.campaign_id = g.campaign_id ORDER BY v.provenance_id DESC LIMIT 1) "
        "FROM campaign_case AS p JOIN campaign AS g ON g.campaign_id = p.campaign_id WHERE p.case_key = ? "
        "ORDER BY g.campaign_id, p.point",
        *key);
    while (rows.next()) {
        auto name = rows.get<std::string>(0);
        const auto attempts = !places.empty() && places.back().campaign == name
                                  ? places.back().attempts
                                  : campaign::remarks_in(rows.get<std::string_view>(3)).attempts;
        places.push_back(
            {std::move(name), rows.get<std::int64_t>(1), rows.get<std::optional<std::int64_t>>(2), attempts});
    }
    return places;
}

std::optional<campaign::CaseResult> Store::result(std::string_view case_id) const {
    const auto key = case_key(impl_->db, case_id);
    if (!key) return std::nullopt;
    impl_->require_sound(*key);
    campaign::CaseResult result;
    std::string phases;
    {
        auto rows = impl_->db.ask(
            "SELECT number, outcome, coalesce(message, ''), coalesce(wall_seconds, 0.0), coalesce(cpu_seconds, 0.0), "
            "coalesce(particle_steps, 0.0), coalesce(phases, '{}') FROM attempt "
            "WHERE case_key = ?1 AND outcome = (SELECT outcome FROM sim_case WHERE case_key = ?1) "
            "ORDER BY number DESC LIMIT 1",
            *key);
        if (!rows.next()) return std::nullopt;
        result.attempt = {std::string(case_id), rows.get<std::int64_t>(0)};
        result.outcome = outcome_at(rows, 1).value_or(Outcome::abandoned);
        result.message = rows.get<std::string>(2);
        result.cost.wall_seconds = rows.get<double>(3);
        result.cost.cpu_seconds = rows.get<double>(4);
        result.cost.particle_steps = rows.get<double>(5);
        phases = rows.get<std::string>(6);
    }
    auto seconds = campaign::phases_in(phases);
    if (!seconds)
        throw SystemError(fmt::format("database '{}': damaged: the cost of attempt {} of case {} is not as written",
                                      impl_->file.string(), result.attempt.number, case_id));
    result.cost.phases = std::move(*seconds);
    result.observations = observations_of(impl_->db, *key);
    auto lines = imported_lines(impl_->db, *key);
    if (const auto line = lines.find(result.attempt.number); line != lines.end())
        result.imported = std::move(line->second);
    return result;
}

std::int64_t measured_key(const Connection& db, std::int64_t campaign_key, std::string_view campaign,
                          std::string_view observable, bool scalar) {
    auto rows = db.ask(
        "SELECT b.name, b.observable_id FROM observable AS b NOT INDEXED JOIN campaign AS g NOT INDEXED ON b.scene = "
        "g.scene AND b.revision = g.revision WHERE g.campaign_id = ? AND (b.shape = 'scalar') = ? ORDER BY "
        "b.observable_id",
        campaign_key, scalar);
    std::vector<std::string> names;
    while (rows.next()) {
        names.push_back(rows.get<std::string>(0));
        if (names.back() == observable) return rows.get<std::int64_t>(1);
    }
    throw campaign::input_error("observable", observable,
                                fmt::format("the {} of '{}' are {}", scalar ? "scalars" : "series and profiles",
                                            campaign, campaign::listed(names)),
                                campaign::nearest_word(observable, names));
}

std::vector<PlacedValue> Store::values(std::string_view campaign, std::string_view observable) const {
    impl_->require_sound();
    const auto& db = impl_->db;
    const std::int64_t key = impl_->campaign_key(campaign);
    const std::int64_t observable_key = measured_key(db, key, campaign, observable, true);
    std::vector<PlacedValue> values;
    auto rows = db.ask(
        "SELECT p.point, p.sequence, p.replicate, p.case_key, c.outcome, (SELECT o.value FROM observation AS o WHERE "
        "o.case_key = p.case_key AND o.observable_id = ?1 AND o.sample = 0) FROM campaign_case AS p JOIN sim_case AS c "
        "ON c.case_key = p.case_key WHERE p.campaign_id = ?2 ORDER BY p.point, p.replicate",
        observable_key, key);
    while (rows.next()) {
        values.push_back({.point = rows.get<std::int64_t>(0),
                          .sequence = rows.get<std::int64_t>(1),
                          .replicate = rows.get<std::int64_t>(2),
                          .case_key = rows.get<std::int64_t>(3),
                          .outcome = outcome_at(rows, 4),
                          .value = rows.get<double>(5)});
    }
    return values;
}

std::vector<ConvergenceRow> Store::convergence(std::string_view campaign, std::string_view observable) const {
    impl_->require_sound();
    std::vector<ConvergenceRow> history;
    const std::int64_t key = impl_->campaign_key(campaign);
    auto rows = impl_->db.ask(
        "SELECT points, mean, sd, skewness, g1, kurtosis, mean_error, sd_error, skewness_error, g1_error, "
        "kurtosis_error, "
        "zero_share, excluded, converged FROM convergence WHERE campaign_id = ? AND observable = ? ORDER BY points",
        key, observable);
    while (rows.next()) {
        history.push_back({.observable = std::string(observable),
                           .points = rows.get<std::int64_t>(0),
                           .mean = rows.get<double>(1),
                           .sd = rows.get<double>(2),
                           .skewness = rows.get<double>(3),
                           .g1 = rows.get<double>(4),
                           .kurtosis = rows.get<double>(5),
                           .mean_error = rows.get<double>(6),
                           .sd_error = rows.get<double>(7),
                           .skewness_error = rows.get<double>(8),
                           .g1_error = rows.get<double>(9),
                           .kurtosis_error = rows.get<double>(10),
                           .zero_share = rows.get<double>(11),
                           .excluded = rows.get<std::int64_t>(12),
                           .converged = rows.get<std::int64_t>(13) != 0});
    }
    return history;
}

}  // namespace grainsweep::store
