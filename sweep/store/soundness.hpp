// Search for damage in the database: compares ids with inputs, and checksums with contents. It only reads.
//
// In a file without checksums no damage can be found.
#pragma once

#include "sweep/store/checksum.hpp"
#include "sweep/store/database.hpp"

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::store {

struct DamagedCase {
    std::int64_t key = 0;
    std::string id;
    bool identity = false;          ///< scene, revision, seed or inputs do not match the id
    bool answer = false;            ///< outcome, reason, cost or observations are damaged
    std::vector<std::int64_t> log;  ///< damaged attempts
    std::string observable;         ///< the damaged observable, if only one is damaged
    std::string what;               ///< description
};

struct DamagedTable {
    std::string name;
    std::int64_t part = 0;  ///< campaign_id, or 0
    std::string what;
};

/// Returns whether the file's version has checksums; a missing table of checksums is then damage.
[[nodiscard]] bool has_checksums(const Connection& db);
/// Returns whether attempts have the column `threads`; a database that is only read may be older.
[[nodiscard]] bool has_threads(const Connection& db);
[[nodiscard]] bool has_table(const Connection& db, std::string_view table);
[[nodiscard]] bool has_column(const Connection& db, std::string_view table, std::string_view column);

/// Returns the damaged cases among these keys, in order of key. Rows of missing cases are counted in `strays`.
[[nodiscard]] std::vector<DamagedCase> damaged_cases(const Connection& db, std::int64_t first = 0,
                                                     std::int64_t last = std::numeric_limits<std::int64_t>::max(),
                                                     std::int64_t* strays = nullptr);

/// Returns the damaged tables that describe cases and campaigns: campaign, parameter, observable, provenance.
[[nodiscard]] std::vector<DamagedTable> damaged_descriptions(const Connection& db);
/// Returns the damaged views of the program, which only users read. They are no data, and the next run makes them anew.
[[nodiscard]] std::vector<DamagedTable> damaged_views(const Connection& db);
/// Returns the damaged stored campaign files: of the last run of each campaign, or of all runs.
[[nodiscard]] std::vector<DamagedTable> damaged_texts(const Connection& db, bool of_all_runs);
/// Returns tables with impossible numbers, with or without checksums: a negative point, a million attempts. `campaign`
/// 0: all campaigns.
[[nodiscard]] std::vector<DamagedTable> damaged_numbers(const Connection& db, std::int64_t campaign = 0);
/// Returns tables whose rows are not in the order of their keys, so that they cannot be found or safely written.
/// SQLite's quick check does not detect this.
[[nodiscard]] std::vector<DamagedTable> tables_out_of_order(const Connection& db);
/// Returns damaged designs and verdicts: campaign_case and convergence, campaign by campaign.
[[nodiscard]] std::vector<DamagedTable> damaged_parts(const Connection& db);

/// Returns the present sum of the rows of a table or of a part.
[[nodiscard]] RowSum sum_of_table(const Connection& db, std::string_view name, std::int64_t part = 0);
/// Returns the sum of one row of convergence; 0 if there is none.
[[nodiscard]] RowSum sum_of_verdict(const Connection& db, std::int64_t campaign, std::string_view observable,
                                    std::int64_t points);
/// Returns the stored checksum of a table or of a part.
[[nodiscard]] RowSum stored_sum(const Connection& db, std::string_view name, std::int64_t part = 0);
void store_sum(Connection& db, std::string_view name, std::int64_t part, const RowSum& sum);
/// Stores the checksum of the rows after a change.
void renew_sum(Connection& db, std::string_view name, std::int64_t part = 0);
/// Changes a table and its stored checksum. Rows damaged before the change stay detectably damaged.
void change_summed(Connection& db, std::string_view name, const std::function<void()>& change);
/// Calls renew_sum for every table of damaged_descriptions().
void renew_descriptions(Connection& db);

/// Store a checksum of the stored values: of an attempt, of a case's answer, of a case with all its attempts.
void renew_attempt(Connection& db, std::int64_t key, std::int64_t number);
void renew_answer(Connection& db, std::int64_t key);
void renew_case(Connection& db, std::int64_t key);
void renew_all_cases(Connection& db);
/// Stores checksums of all data, when a file gets its first checksums.
void renew_everything(Connection& db);

}  // namespace grainsweep::store
