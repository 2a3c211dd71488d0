#include "sweep/store/soundness.hpp"

#include "sweep/campaign/case.hpp"
#include "sweep/store/database_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace grainsweep::store {

namespace {

// Every statement has NOT INDEXED, so that the tables themselves are checked, as `dump` reads them.

struct Summed {
    std::string_view name;
    std::string_view rows;  ///< a SELECT of all that counts; ?1: the part
    bool by_campaign = false;
};

constexpr std::string_view views = "sqlite_schema", resolved_campaigns = "campaign.resolved";

constexpr std::array summed_tables = {
    Summed{"campaign",
           "SELECT campaign_id, name, scene, revision, seed, factors, fixed, condition, design, design_options, "
           "design_extent, sequences, replicates, convergence_observable, convergence_rule, convergence_gates, "
           "convergence_tolerance, convergence_block, convergence_stop, stopped_at, candidates, asked_candidates, "
           "asked_replicates FROM campaign NOT INDEXED"},
    // Of schema 12: none in an older database.
    Summed{resolved_campaigns, "SELECT campaign_id, resolved FROM campaign NOT INDEXED"},
    Summed{"parameter",
           "SELECT parameter_id, scene, revision, name, unit, meaning, default_value FROM parameter NOT INDEXED"},
    Summed{"observable",
           "SELECT observable_id, scene, revision, name, unit, meaning, shape FROM observable NOT INDEXED"},
    Summed{"provenance",
           "SELECT provenance_id, campaign_id, version, \"commit\", compiler, flags, instruction_path, processor, "
           "host, start, campaign_hash FROM provenance NOT INDEXED"},
    Summed{
        "attempt_computer",
        "SELECT computer_id, version, \"commit\", build, instruction_path, processor, host FROM attempt_computer NOT "
        "INDEXED"},
    // Only the program's own; additions of a user are no damage.
    Summed{views,
           "SELECT name, sql FROM sqlite_schema WHERE type = 'view' AND (name IN ('series', 'inputs', "
           "'convergence_history') OR name IN (SELECT name FROM campaign NOT INDEXED))"},
    Summed{"campaign_case",
           "SELECT point, replicate, sequence, case_key FROM campaign_case NOT INDEXED WHERE campaign_id = ?1", true},
    Summed{"convergence",
           "SELECT observable, points, mean, sd, skewness, g1, kurtosis, mean_error, sd_error, skewness_error, "
           "g1_error, kurtosis_error, zero_share, excluded, converged FROM convergence NOT INDEXED "
           "WHERE campaign_id = ?1",
           true},
};

bool is_there(const Connection& db, const Summed& table) {
    return table.name != resolved_campaigns || has_column(db, "campaign", "resolved");
}

const Summed& summed(std::string_view name) {
    return *std::ranges::find(summed_tables, name, &Summed::name);
}

RowSum sum_of_places(const Connection& db, std::int64_t campaign) {
    RowSum sum;
    auto rows = db.ask(summed("campaign_case").rows, campaign);
    while (rows.next()) {
        sum.add(checksum_of_place(rows.get<std::int64_t>(0), rows.get<std::int64_t>(1), rows.get<std::int64_t>(2),
                                  rows.get<std::int64_t>(3)));
    }
    return sum;
}

/// Of every cell of every row.
RowSum sum_of_rows(Statement& statement) {
    RowSum sum;
    Digest digest;
    while (statement.step()) {
        digest.clear();
        for (int column = 0; column < statement.columns(); ++column) digest.add(statement.cell(column));
        sum.add(digest.value());
    }
    return sum;
}

std::vector<std::int64_t> parts_of(const Connection& db, std::string_view table) {
    return db.column<std::int64_t>(
        fmt::format("SELECT campaign_id FROM {} NOT INDEXED UNION SELECT part FROM table_checksum WHERE name = ? "
                    "ORDER BY 1",
                    table),
        table);
}

void compare(const Connection& db, std::string_view table, std::int64_t part, std::vector<DamagedTable>& found) {
    const RowSum is = sum_of_table(db, table, part);
    const RowSum was = stored_sum(db, table, part);
    if (is == was) return;
    const std::string what = is.rows == was.rows
                                 ? fmt::format("one or more of its {} rows are not as written", is.rows)
                                 : fmt::format("it has {} rows, and {} were written", is.rows, was.rows);
    found.push_back({std::string(table), part, what});
}

}  // namespace

bool has_checksums(const Connection& db) {
    constexpr std::int64_t first_with_checksums = 5;  // results_schema/005_checksums.sql
    auto version = db.prepare("PRAGMA user_version");
    return version.step() && version.get<std::int64_t>(0) >= first_with_checksums;
}

bool has_threads(const Connection& db) {
    return has_column(db, "attempt", "threads");
}

bool has_table(const Connection& db, std::string_view table) {
    return db.value<std::int64_t>("SELECT 1 FROM sqlite_schema WHERE name = ?", table).has_value();
}

// The statement, not the function pragma_table_info(): a view of that name would stand before it.
bool has_column(const Connection& db, std::string_view table, std::string_view column) {
    auto rows = db.prepare(fmt::format("PRAGMA table_info({})", quoted_name(table)));
    while (rows.step()) {
        if (rows.get<std::string_view>(1) == column) return true;
    }
    return false;
}

RowSum sum_of_table(const Connection& db, std::string_view name, std::int64_t part) {
    if (name == "campaign_case") return sum_of_places(db, part);
    const auto& table = summed(name);
    Statement statement = db.prepare(table.rows);
    if (table.by_campaign) statement.bind(1, part);
    return sum_of_rows(statement);
}

RowSum sum_of_verdict(const Connection& db, std::int64_t campaign, std::string_view observable, std::int64_t points) {
    Statement statement = db.prepare(std::string(summed("convergence").rows) + " AND observable = ?2 AND points = ?3");
    statement.bind(1, campaign);
    statement.bind(2, observable);
    statement.bind(3, points);
    return sum_of_rows(statement);
}

RowSum stored_sum(const Connection& db, std::string_view name, std::int64_t part) {
    auto rows = db.ask("SELECT rows, checksum FROM table_checksum WHERE name = ? AND part = ?", name, part);
    if (!rows.next()) return {};
    return {rows.get<std::int64_t>(0), static_cast<std::uint64_t>(rows.get<std::int64_t>(1))};
}

void store_sum(Connection& db, std::string_view name, std::int64_t part, const RowSum& sum) {
    db.run(
        "INSERT INTO table_checksum (name, part, rows, checksum) VALUES (?, ?, ?, ?) "
        "ON CONFLICT (name, part) DO UPDATE SET rows = excluded.rows, checksum = excluded.checksum",
        name, part, sum.rows, as_sql(sum.sum));
}

void renew_sum(Connection& db, std::string_view name, std::int64_t part) {
    store_sum(db, name, part, sum_of_table(db, name, part));
}

void change_summed(Connection& db, std::string_view name, const std::function<void()>& change) {
    const bool as_written = sum_of_table(db, name) == stored_sum(db, name);
    change();
    if (as_written) renew_sum(db, name);
}

std::vector<DamagedTable> damaged_descriptions(const Connection& db) {
    std::vector<DamagedTable> damaged;
    if (!has_checksums(db)) return damaged;
    for (const auto& table : summed_tables) {
        if (!table.by_campaign && table.name != views && is_there(db, table)) compare(db, table.name, 0, damaged);
    }
    return damaged;
}

std::vector<DamagedTable> damaged_views(const Connection& db) {
    std::vector<DamagedTable> damaged;
    if (has_checksums(db)) compare(db, views, 0, damaged);
    return damaged;
}

std::vector<DamagedTable> damaged_texts(const Connection& db, bool of_all_runs) {
    std::vector<DamagedTable> damaged;
    auto rows = db.ask(
        "SELECT campaign_id, provenance_id, campaign_text, campaign_hash FROM provenance AS v NOT INDEXED WHERE ?1 OR "
        "provenance_id = (SELECT max(provenance_id) FROM provenance AS w NOT INDEXED WHERE w.campaign_id = "
        "v.campaign_id)",
        of_all_runs);
    while (rows.next()) {
        if (campaign::content_hash(rows.get<std::string_view>(2)) == rows.get<std::string_view>(3)) continue;
        damaged.push_back({"provenance", rows.get<std::int64_t>(0),
                           fmt::format("the campaign file of run {} is not as written", rows.get<std::int64_t>(1))});
    }
    return damaged;
}

std::vector<DamagedTable> damaged_numbers(const Connection& db, std::int64_t campaign) {
    // Points, repeats and attempts are counted one by one: none of them comes near these.
    constexpr std::int64_t most_counted = 100'000'000, most_attempts = 1'000'000;
    struct Bounded {
        std::string_view table, campaign, what, condition;
    };
    const std::array bounded = {
        Bounded{"campaign", "campaign_id", "it has a count, a block or a revision out of range",
                "revision NOT BETWEEN 0 AND ?1 OR sequences NOT BETWEEN 1 AND ?1 OR replicates NOT BETWEEN 1 AND ?1 OR "
                "stopped_at NOT BETWEEN 0 AND ?1 OR convergence_block NOT BETWEEN 1 AND ?1 OR design_extent GLOB "
                "'*points = "
                "[0-9][0-9][0-9][0-9][0-9][0-9][0-9][0-9][0-9][0-9]*'"},
        Bounded{"campaign_case", "campaign_id", "it has a point, replicate or sequence out of range",
                "point NOT BETWEEN 0 AND ?1 OR replicate NOT BETWEEN 0 AND ?1 OR sequence NOT BETWEEN 0 AND ?1"},
        Bounded{"convergence", "campaign_id", "it has a count of points or cases out of range",
                "points NOT BETWEEN 0 AND ?1 OR excluded NOT BETWEEN 0 AND ?1"},
        Bounded{"sim_case", "0", "it has a count of attempts or a revision out of range",
                "attempts NOT BETWEEN 0 AND ?2 OR failures NOT BETWEEN 0 AND ?2 OR revision NOT BETWEEN 0 AND ?1"},
        Bounded{"attempt", "0", "it has an attempt whose number is out of range", "number NOT BETWEEN 1 AND ?2"},
    };
    std::vector<DamagedTable> damaged;
    const auto find = [&](const Bounded& one) {
        auto rows = db.ask(fmt::format("SELECT {} FROM {} NOT INDEXED WHERE ({}) AND (?3 = 0 OR ?3 = {}) LIMIT 1",
                                       one.campaign, one.table, one.condition, one.campaign),
                           most_counted, most_attempts, campaign);
        if (rows.next()) damaged.push_back({std::string(one.table), rows.get<std::int64_t>(0), std::string(one.what)});
    };
    for (const auto& one : bounded) find(one);
    if (has_column(db, "campaign", "candidates"))
        find({"campaign", "campaign_id", "it has a count of points or repeats out of range",
              "candidates NOT BETWEEN 0 AND ?1 OR asked_candidates NOT BETWEEN 0 AND ?1 OR asked_replicates NOT "
              "BETWEEN 1 AND ?1"});
    return damaged;
}

std::vector<DamagedTable> tables_out_of_order(const Connection& db) {
    std::vector<DamagedTable> found;
    // `*`: an index that has the key's columns would else be read in its own order in place of the table.
    for (const auto& [table, columns] : {std::pair{"case_input", "case_key, parameter_id"},
                                         {"attempt", "case_key, number"},
                                         {"observation", "case_key, observable_id, sample"},
                                         {"campaign_case", "campaign_id, point, replicate"},
                                         {"convergence", "campaign_id, observable, points"}}) {
        auto rows = db.prepare(fmt::format("SELECT {}, * FROM {} NOT INDEXED", columns, table));
        const auto keys = static_cast<int>(1 + std::ranges::count(std::string_view(columns), ','));
        std::vector<SqlValue> before, now(static_cast<std::size_t>(keys));
        while (rows.step()) {
            for (int k = 0; k < keys; ++k) now[static_cast<std::size_t>(k)] = rows.cell(k);
            if (!before.empty() && !(before < now)) {
                found.push_back(
                    {table, 0, fmt::format("its rows are not in the order of their keys; {}", how_to_copy_out)});
                break;
            }
            before = now;
        }
    }
    return found;
}

std::vector<DamagedTable> damaged_parts(const Connection& db) {
    std::vector<DamagedTable> damaged;
    if (!has_checksums(db)) return damaged;
    for (const auto& table : summed_tables) {
        if (!table.by_campaign) continue;
        for (const auto part : parts_of(db, table.name)) compare(db, table.name, part, damaged);
    }
    auto rows = db.ask(
        "SELECT campaign_id, count(*) FROM campaign_case AS p NOT INDEXED WHERE NOT EXISTS "
        "(SELECT 1 FROM sim_case AS c WHERE c.case_key = p.case_key) GROUP BY campaign_id");
    while (rows.next()) {
        damaged.push_back({"campaign_case", rows.get<std::int64_t>(0),
                           fmt::format("{} of its places have no case", rows.get<std::int64_t>(1))});
    }
    return damaged;
}

void renew_descriptions(Connection& db) {
    for (const auto& table : summed_tables) {
        if (!table.by_campaign && is_there(db, table)) renew_sum(db, table.name);
    }
}

void renew_everything(Connection& db) {
    renew_all_cases(db);
    for (const auto& table : summed_tables) {
        if (!table.by_campaign) continue;
        for (const auto part : parts_of(db, table.name)) renew_sum(db, table.name, part);
    }
    renew_descriptions(db);
}

}  // namespace grainsweep::store
