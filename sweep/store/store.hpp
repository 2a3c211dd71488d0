// The archive: every result of every campaign in one SQLite file. The only file that speaks SQL.
//
// One writer. WAL, synchronous FULL. A result is on disk before it is shown: callers write inside
// group() and show what the group held only after it returned.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/campaign/case.hpp"
#include "sweep/store/broken_world.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace grainsweep::store {

/// Who computes: stored once per run, referred to by every attempt.
struct Provenance {
    std::string version, commit, compiler, flags, instruction_path, processor, host;
};

/// What the archive knows of a case of the campaign.
struct CaseState {
    std::int64_t attempts = 0;                 ///< highest attempt number begun
    std::int64_t failures = 0;                 ///< attempts that crashed or timed out
    std::optional<campaign::Outcome> outcome;  ///< of the last finished attempt
};

struct LoggedAttempt {
    std::int64_t number = 0;
    std::optional<campaign::Outcome> outcome;  ///< none: running, or its boss died
    std::string message;
    double wall_seconds = 0;
    std::string started, host, version, instruction_path;  ///< version (commit) of the program
};

/// Rows for the commands: column names and cells (NULL, integer, real, text).
struct Table {
    using Cell = std::variant<std::monostate, std::int64_t, double, std::string>;
    std::vector<std::string> columns;
    std::vector<std::vector<Cell>> rows;
};

/// One checkpoint of a campaign's convergence. NaN: undefined, stored as NULL.
struct ConvergenceRow {
    std::string observable;
    std::int64_t points = 0;
    double mean, sd, skewness, g1, kurtosis;
    double mean_error, sd_error, skewness_error, g1_error, kurtosis_error;
    double zero_share = 0;
    std::int64_t excluded = 0;
    bool converged = false;
};

/// A stored value of one scalar at one place of the design.
struct PlacedValue {
    std::int64_t point = 0, sequence = 0, replicate = 0;
    std::optional<campaign::Outcome> outcome;
    double value = 0;  ///< NaN where there is none
};

struct CampaignRecord {
    std::string name, scene, text, design;
    int revision = 1;
    std::int64_t sequences = 1, replicates = 1;
    std::optional<campaign::Convergence> convergence;
    std::optional<std::int64_t> stopped_at;  ///< points in the prefix at which it converged and stopped
};

class Store {
public:
    enum class Mode { create, read };
    /// create: makes the file and its schema where absent, takes the writer's lock (a second writer is
    /// refused with a sentence naming the first); read: never writes. Throws BrokenWorld, or WrongQuestion
    /// when the file is no grainsweep database.
    Store(const std::filesystem::path& file, Mode mode);
    ~Store();
    Store(Store&&) noexcept;
    Store& operator=(Store&&) noexcept;

    /// Records campaign and cases (idempotent; extends), makes its view, closes attempts of a dead boss as
    /// abandoned. Another scene, revision, factor set, range or fixed value under the same name throws WrongQuestion.
    /// Returns the state of each case, in the order given.
    std::vector<CaseState> enrol(const campaign::Campaign& campaign, std::span<const campaign::PlacedCase> cases,
                                 const Provenance& provenance);

    /// Runs `writes` in one durable transaction: on disk when this returns, absent when it throws.
    void group(const std::function<void()>& writes);
    // Inside group():
    void begin(const campaign::Attempt& attempt);
    /// A result whose attempt is not the case's latest is stale: dropped, returns false.
    bool finish(const campaign::CaseResult& result);
    void record(std::string_view campaign, const ConvergenceRow& row);
    void stop(std::string_view campaign, std::int64_t points);

    // Questions
    [[nodiscard]] std::vector<CampaignRecord> campaigns() const;
    [[nodiscard]] std::optional<campaign::Case> find_case(std::string_view id_or_prefix) const;
    [[nodiscard]] std::vector<LoggedAttempt> attempts(std::string_view case_id) const;
    [[nodiscard]] std::optional<campaign::CaseResult> result(std::string_view case_id) const;
    /// One scalar over the campaign's design, ordered by (point, replicate).
    [[nodiscard]] std::vector<PlacedValue> values(std::string_view campaign, std::string_view observable) const;
    [[nodiscard]] std::vector<ConvergenceRow> convergence(std::string_view campaign, std::string_view observable) const;
    /// Counts by outcome per campaign, rate and time left: the status table.
    [[nodiscard]] Table status() const;
    /// Read-only SQL: anything else throws WrongQuestion with SQLite's sentence.
    [[nodiscard]] Table query(std::string_view sql) const;
    /// Canonical text of all results: no times, attempts, hosts; equal for equal science.
    void dump(const std::function<void(std::string_view line)>& sink) const;

    struct Impl;  ///< known to the files of this room only

private:
    std::unique_ptr<Impl> impl_;
};

}  // namespace grainsweep::store
