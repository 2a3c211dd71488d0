// Whether what the archive holds is what was written: ids against inputs, checksums against contents. Pure reading.
//
// A file from before there were checksums has nothing to compare with: nothing of it is found damaged.
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
    bool identity = false;          ///< scene, revision, seed or inputs do not give the id
    bool answer = false;            ///< outcome, reason, cost or observations are not as written
    std::vector<std::int64_t> log;  ///< attempts that are not as written
    std::string observable;         ///< the damaged one, where it is one
    std::string what;               ///< in words
};

struct DamagedTable {
    std::string name;
    std::int64_t part = 0;  ///< campaign_id, or 0
    std::string what;
};

/// Whether the file is of a version that has them: a table of them that is missing there is damage.
[[nodiscard]] bool has_checksums(const Connection& db);
/// Whether attempts have a column `threads`: an archive that is only read may be of an older form.
[[nodiscard]] bool has_threads(const Connection& db);
[[nodiscard]] bool has_table(const Connection& db, std::string_view table);
[[nodiscard]] bool has_column(const Connection& db, std::string_view table, std::string_view column);

/// Among the cases with these keys, in order of key. Rows of cases that are not there are counted in `strays`.
[[nodiscard]] std::vector<DamagedCase> damaged_cases(const Connection& db, std::int64_t first = 0,
                                                     std::int64_t last = std::numeric_limits<std::int64_t>::max(),
                                                     std::int64_t* strays = nullptr);

/// Tables that describe cases and campaigns: campaign, parameter, observable, provenance.
[[nodiscard]] std::vector<DamagedTable> damaged_descriptions(const Connection& db);
/// Our views, which users alone read: they are no data, and the next run makes them anew.
[[nodiscard]] std::vector<DamagedTable> damaged_views(const Connection& db);
/// Campaign files as the runs read them: of the last run of each campaign, or all.
[[nodiscard]] std::vector<DamagedTable> damaged_texts(const Connection& db, bool of_all_runs);
/// Numbers that no run writes, with or without checksums: a negative point, a case tried a million times. 0: of every
/// campaign.
[[nodiscard]] std::vector<DamagedTable> damaged_numbers(const Connection& db, std::int64_t campaign = 0);
/// Tables that are kept in the order of their keys and are not: their rows cannot be found, nor safely written.
/// SQLite's quick check does not see it.
[[nodiscard]] std::vector<DamagedTable> tables_out_of_order(const Connection& db);
/// Designs and verdicts: campaign_case and convergence, campaign by campaign.
[[nodiscard]] std::vector<DamagedTable> damaged_parts(const Connection& db);

/// The rows of a table, or of its part, as they are now.
[[nodiscard]] RowSum sum_of_table(const Connection& db, std::string_view name, std::int64_t part = 0);
/// One row of convergence, or none.
[[nodiscard]] RowSum sum_of_verdict(const Connection& db, std::int64_t campaign, std::string_view observable,
                                    std::int64_t points);
/// The checksum that is stored of it.
[[nodiscard]] RowSum stored_sum(const Connection& db, std::string_view name, std::int64_t part = 0);
void store_sum(Connection& db, std::string_view name, std::int64_t part, const RowSum& sum);
/// Stores the checksum of the rows after a change.
void renew_sum(Connection& db, std::string_view name, std::int64_t part = 0);
/// Changes a table and its stored checksum. Rows that are not as written before the change stay damaged after it.
void change_summed(Connection& db, std::string_view name, const std::function<void()>& change);
/// renew_sum of every table of damaged_descriptions().
void renew_descriptions(Connection& db);

/// Stores a checksum of the stored values: of an attempt, of a case's answer, of a case with all its attempts.
void renew_attempt(Connection& db, std::int64_t key, std::int64_t number);
void renew_answer(Connection& db, std::int64_t key);
void renew_case(Connection& db, std::int64_t key);
void renew_all_cases(Connection& db);
/// Of everything: once, when a file gets its first checksums.
void renew_everything(Connection& db);

}  // namespace grainsweep::store
