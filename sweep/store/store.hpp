// The archive: every result of every campaign in one SQLite file.
//
// One writer: an advisory lock on the file itself, which ends with its holder. Readers go on beside it, and the last
// one to close the file, reader or writer, leaves nothing beside it. WAL, synchronous FULL; on a network disk, asked
// for, a rollback journal. A result is on disk before it is shown: callers write inside group() and show
// what the group held only after it returned. A Store belongs to one thread.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/campaign/case.hpp"
#include "sweep/campaign/identity.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/files/broken_world.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace grainsweep::store {

/// What runs a campaign, and where: stored once per run. What computed an attempt is stored with the attempt.
struct Provenance {
    std::string version, commit, compiler, flags, instruction_path, processor, host;
};

/// State of a case of the campaign in the archive.
struct CaseState {
    std::int32_t attempts = 0;                 ///< highest attempt number begun
    std::int32_t failures = 0;                 ///< attempts that crashed or timed out
    std::optional<campaign::Outcome> outcome;  ///< of the last finished attempt
};

struct LoggedAttempt {
    std::int64_t number = 0;
    std::optional<campaign::Outcome> outcome;  ///< none: running, or its main program died
    std::string message;
    double wall_seconds = 0;  ///< NaN: running, or its main program died
    std::string started;
    campaign::Computer computer;  ///< of an archive older than these columns: what ran the campaign; no build
    double threads = std::numeric_limits<double>::quiet_NaN();  ///< a mean over its computing time; NaN: not known
    std::optional<campaign::ProgramFacts> program = {};         ///< none: a scene of the solver
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
    std::int64_t case_key = 0;  ///< the same at every place where the case stands
    std::optional<campaign::Outcome> outcome;
    double value = 0;  ///< NaN where there is none
};

/// The places that one curve of a point covers.
struct CurveExtent {
    std::int64_t point = 0;
    double first = 0, last = 0;
};

/// Where a case stands, and what decides there whether it runs.
struct CasePlace {
    std::string campaign;
    std::int64_t point = 0;
    std::optional<std::int64_t> stopped_at;  ///< of the campaign
    std::optional<std::int64_t> attempts;    ///< limits.attempts of its last run, where that said so
};

/// A file that a campaign used.
struct StoredFile {
    std::string place, name, hash;      ///< where its campaign file names it, how, and the hash of its contents
    std::optional<std::int64_t> bytes;  ///< none: the contents are not stored
};

/// How much of its design a campaign has: points the design numbers, and repeats of each.
struct Extent {
    std::int64_t candidates = 0;  ///< those that the `where` clause leaves out included
    std::int64_t replicates = 1;
    bool operator==(const Extent&) const = default;
};

/// Content of a campaign, and how far it has come.
struct CampaignRecord : campaign::Identity {
    std::string text;  ///< the campaign file of its last run
    std::int64_t sequences = 1, replicates = 1;
    Extent stored;  ///< never shrinks: what view and statistics are over
    Extent asked;   ///< by the last run
    std::optional<campaign::Convergence> convergence;
    std::optional<std::int64_t> stopped_at;  ///< it converged and stopped: points numbered below this count

    /// The last run asked for a part of what is stored.
    [[nodiscard]] bool shrunk() const {
        return asked.candidates < stored.candidates || asked.replicates < stored.replicates;
    }
};

/// The places of a campaign's design, ordered by (point, replicate), and the state of their cases in the archive.
struct StoredPlaces {
    std::vector<campaign::Place> places;
    std::vector<campaign::CaseHash> hashes;
    std::vector<CaseState> states;
};

/// What is not as it was written.
struct Damage {
    std::string kind;        ///< "case", "table" or "file"
    std::string case_id;     ///< of a case
    std::string campaign;    ///< one or several, as far as it belongs to any
    std::string observable;  ///< where one alone is damaged
    std::string what;        ///< in words
};

class Store {
public:
    enum class Mode { create, read };
    /// A network disk gets a rollback journal instead of a write-ahead log; found out by statfs(2) it is refused.
    enum class Disk { found_out, local, network };
    /// create: makes the file and its schema where absent, takes the writer's lock and updates an older schema. A
    /// second writer is refused with a sentence that names the first. read: changes no content and no schema. Throws
    /// BrokenWorld, or WrongQuestion when the file is no grainsweep database.
    Store(const std::filesystem::path& file, Mode mode, Disk disk = Disk::found_out);
    ~Store();
    Store(Store&&) noexcept;
    Store& operator=(Store&&) noexcept;

    /// Records campaign and cases (idempotent; extends), makes its view, closes attempts of a dead main program as
    /// abandoned. Returns the state of each case, in the order given. Not inside group().
    ///
    /// Throws WrongQuestion naming both for another scene, revision, default, factor set, range, fixed value,
    /// condition, seed, kind of design, scramble or first index under the same name. So does another size of a design
    /// that does not extend (latin_hypercube, levels of a lattice). More points or replicates extend; a part of what is
    /// there is accepted, removes nothing and is kept beside the extent (CampaignRecord). If a factor of a lattice
    /// gains levels, the points are renumbered. New places replace the old ones, and every answer is kept and stays in
    /// the view. Convergence is judged anew, as after another rule or more replicates. A list only grows at
    /// its end.
    ///
    /// Places beyond `at_once` new ones are left to enrol_more(), so that a long campaign can begin before all of it is
    /// in the file. Places that are missing when the program ends are added by its next run.
    std::vector<CaseState> enrol(const campaign::Campaign& campaign, const campaign::Cases& cases,
                                 const Provenance& provenance,
                                 std::size_t at_once = std::numeric_limits<std::size_t>::max());
    /// Whether places of the campaign enrolled last are left.
    [[nodiscard]] bool enrols() const;
    /// Adds up to that number of them, on disk when this returns. Not inside group().
    void enrol_more(std::size_t places);

    /// What the last enrol found damaged and what it did about it, a sentence each.
    [[nodiscard]] const std::vector<std::string>& notes() const;

    /// Throws BrokenWorld where the file was moved, deleted or replaced since it was opened; group() does, too.
    void require_in_place() const;

    /// Checks every row, then stores a checksum of the file: unchanged, it need not be checked again. Throws
    /// BrokenWorld naming what was damaged during the run. Does nothing where something was damaged before.
    void remember_file();

    /// Runs `writes` in one durable transaction: on disk when this returns, absent when it throws.
    void group(const std::function<void()>& writes);
    // Inside group():
    /// Numbers only grow: throws std::logic_error for a case that is unknown or has begun a later attempt. Where the
    /// case is among those left to enrol_more(), all of them are entered.
    /// `computer`: what computes it; all empty where that is not known.
    void begin(const campaign::Attempt& attempt, const campaign::Computer& computer = {});
    /// An answer (completed, skipped, unstable, rejected) replaces what an earlier attempt left; an attempt that
    /// brought none leaves an earlier answer in place. A result whose attempt is not the case's latest, or is closed
    /// already, is stale: dropped, returns false. NaN is stored as NULL, a scalar that is NaN not at all. Throws
    /// std::logic_error for an observable that the scene has not declared.
    bool finish(const campaign::CaseResult& result);
    void record(std::string_view campaign, const ConvergenceRow& row);
    /// Deletes what was recorded, and where the campaign stopped.
    void forget_checks(std::string_view campaign);
    /// Stores where the campaign converged and stopped; nothing: it goes on.
    void stop(std::string_view campaign, std::optional<std::int64_t> points);

    // Questions. Those about results compare what they read with its checksums, once per Store, and throw BrokenWorld
    // naming what is damaged; status, places, attempts and query do not.
    [[nodiscard]] std::vector<CampaignRecord> campaigns() const;
    /// The names of a campaign's factors in the order that fixes the dimensions of its design; empty where there is
    /// no campaign of that name.
    [[nodiscard]] std::vector<std::string> factor_order(std::string_view campaign) const;
    /// The stored campaign of that name, none where there is none. Throws WrongQuestion where enrol() would, because it
    /// is another campaign.
    [[nodiscard]] std::optional<CampaignRecord> stored(const campaign::Campaign& campaign) const;
    /// How many of these cases are settled, whichever campaign asked them.
    [[nodiscard]] std::int64_t settled(const campaign::Cases& cases) const;
    [[nodiscard]] bool is_settled(std::string_view case_id) const;
    [[nodiscard]] StoredPlaces placement(std::string_view campaign) const;
    /// Throws WrongQuestion where several cases begin so.
    [[nodiscard]] std::optional<campaign::Case> find_case(std::string_view id_or_prefix) const;
    /// The program that answers the cases of a scene, with the contents of its files; none where it is no program's, or
    /// of an archive that has none. Throws BrokenWorld where it is not as it was written.
    [[nodiscard]] std::shared_ptr<const campaign::Program> program(std::string_view scene) const;
    /// Files of the campaigns that a case belongs to.
    [[nodiscard]] std::vector<StoredFile> files_of(std::string_view case_id) const;
    /// Makes the contents of files that a case names known to this process, as far as they are stored: they stand
    /// before what lies at the paths of then. Throws BrokenWorld where they are not as written.
    void enter_files_of(const campaign::Case& question) const;
    [[nodiscard]] std::vector<LoggedAttempt> attempts(std::string_view case_id) const;
    [[nodiscard]] std::vector<CasePlace> places(std::string_view case_id) const;
    /// The answer that stands, or how the last attempt ended where there is none.
    [[nodiscard]] std::optional<campaign::CaseResult> result(std::string_view case_id) const;
    /// One scalar over the campaign's design, ordered by (point, replicate).
    [[nodiscard]] std::vector<PlacedValue> values(std::string_view campaign, std::string_view observable) const;
    /// The same of a series or profile, at one place along it: time, or bin at the last time. Between two samples on
    /// the line through them, in whichever order they are stored; several at one place count as their mean; NaN outside
    /// of them all.
    [[nodiscard]] std::vector<PlacedValue> values_along(std::string_view campaign, std::string_view observable,
                                                        double at) const;
    /// First and last place of every curve of an observable that has one.
    [[nodiscard]] std::vector<CurveExtent> curve_extents(std::string_view campaign, std::string_view observable) const;
    [[nodiscard]] std::vector<ConvergenceRow> convergence(std::string_view campaign, std::string_view observable) const;
    /// One row per campaign: campaign, scene, cases, one count per outcome, waiting (no outcome yet), stopped_at,
    /// rate (answers per second of the last run), time_left (s, at that rate; NULL where none is known); then
    /// candidates (points the design numbers), dropped (of those, left out by the `where` clause), points (the rest),
    /// replicates, finished (cases with an outcome, abandoned ones not counted) and what the last run asked for,
    /// asked_points (candidates) and asked_replicates.
    [[nodiscard]] Table status() const;
    /// One statement of read-only SQL: anything else throws WrongQuestion with SQLite's sentence, the names there are
    /// and the nearest. Has SQLite's own functions and the aggregates of aggregates.hpp.
    [[nodiscard]] Table query(std::string_view sql) const;
    /// The same row by row: bounded memory, whatever there is to tell.
    struct QueryLimits {
        double seconds = 0;      ///< of processor time; 0: no limit
        std::int64_t bytes = 0;  ///< that SQLite may take; 0: no limit
    };
    void query(std::string_view sql, const QueryLimits& limits,
               const std::function<void(const std::vector<std::string>& columns)>& begin,
               const std::function<void(const std::vector<Table::Cell>& row)>& each) const;
    /// Canonical text of all results, line by line without line breaks: no times, attempts, hosts; equal for equal
    /// science. The form is described in dump.cpp.
    void dump(const std::function<void(std::string_view line)>& sink) const;

    /// Reads everything, compares every checksum, recomputes every id from the stored inputs. Empty: nothing is
    /// damaged.
    [[nodiscard]] std::vector<Damage> verify() const;
    /// Whether the file has checksums: one from before has none until the next run brings it up to date.
    [[nodiscard]] bool has_checksums() const;

    struct Impl;  ///< known to the files of this folder only

private:
    std::unique_ptr<Impl> impl_;
};

}  // namespace grainsweep::store
