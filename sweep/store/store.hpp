// Store: all results of all campaigns in one SQLite file.
//
// There is one writer, by an advisory lock on the file itself, which ends with its process. Readers work at the same
// time. The last process to close the file leaves no other file beside it. The journal is WAL with synchronous FULL,
// or, on request for a network disk, a rollback journal. A result is on disk before it is shown: callers write inside
// group() and show results only after it has returned. A Store belongs to one thread.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/campaign/case.hpp"
#include "sweep/campaign/identity.hpp"
#include "sweep/campaign/program.hpp"
#include "sweep/files/system_error.hpp"

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

/// Program and machine of a run, stored once per run. The program and machine of an attempt are stored with the
/// attempt.
struct Provenance {
    std::string version, commit, compiler, flags, instruction_path, processor, host;
};

/// State of a case in the database.
struct CaseState {
    std::int32_t attempts = 0;                 ///< highest attempt number begun
    std::int32_t failures = 0;                 ///< attempts that crashed or timed out
    std::optional<campaign::Outcome> outcome;  ///< of the last finished attempt
};

struct LoggedAttempt {
    std::int64_t number = 0;
    std::optional<campaign::Outcome> outcome;  ///< empty: running, or its main program died
    std::string message;
    double wall_seconds = 0;  ///< NaN: running, or its main program died
    std::string started;
    campaign::Computer computer;  ///< in a database older than these columns: program of the run, without build
    double threads = std::numeric_limits<double>::quiet_NaN();  ///< mean over its computing time; NaN: unknown
    std::optional<campaign::ProgramFacts> program = {};         ///< empty: a scene of the solver
    std::optional<campaign::ImportedLine> imported = {};        ///< empty: computed by a run
};

/// Table for commands: column names and cells (NULL, integer, real, text).
struct Table {
    using Cell = std::variant<std::monostate, std::int64_t, double, std::string>;
    std::vector<std::string> columns;
    std::vector<std::vector<Cell>> rows;
};

/// Checkpoint of a campaign's convergence. NaN: undefined, stored as NULL.
struct ConvergenceRow {
    std::string observable;
    std::int64_t points = 0;
    double mean, sd, skewness, g1, kurtosis;
    double mean_error, sd_error, skewness_error, g1_error, kurtosis_error;
    double zero_share = 0;
    std::int64_t excluded = 0;
    bool converged = false;
};

/// Stored value of a scalar at a place of the design.
struct PlacedValue {
    std::int64_t point = 0, sequence = 0, replicate = 0;
    std::int64_t case_key = 0;  ///< the same at every place of the case
    std::optional<campaign::Outcome> outcome;
    double value = 0;  ///< NaN: none
};

/// First and last place of a curve of a point.
struct CurveExtent {
    std::int64_t point = 0;
    double first = 0, last = 0;
};

/// Place of a case, with the conditions that decide there whether it runs.
struct CasePlace {
    std::string campaign;
    std::int64_t point = 0;
    std::optional<std::int64_t> stopped_at;  ///< of the campaign
    std::optional<std::int64_t> attempts;    ///< limits.attempts of its last run, if given
};

/// File that a campaign used.
struct StoredFile {
    std::string place, name, hash;      ///< path in the campaign file, name there, and hash of its contents
    std::optional<std::int64_t> bytes;  ///< empty: the contents are not stored
};

/// Extent of a campaign's design: number of points, and replicates of each.
struct Extent {
    std::int64_t candidates = 0;  ///< including points that the `where` clause excludes
    std::int64_t replicates = 1;
    bool operator==(const Extent&) const = default;
};

/// Stored campaign and its progress.
struct CampaignRecord : campaign::Identity {
    std::string text;  ///< campaign file of its last run
    std::int64_t sequences = 1, replicates = 1;
    Extent stored;  ///< never shrinks; used by the view and the statistics
    Extent asked;   ///< requested by the last run
    std::optional<campaign::Convergence> convergence;
    std::optional<std::int64_t> stopped_at;  ///< it converged and stopped: points with smaller numbers count
    /// Campaign into which its cases were imported; empty: its cases are of a design.
    std::optional<std::string> imported_into = {};

    /// Returns whether the last run requested only a part of the stored extent.
    [[nodiscard]] bool shrunk() const {
        return asked.candidates < stored.candidates || asked.replicates < stored.replicates;
    }
};

/// Places of a campaign's design, ordered by (point, replicate), and the states of their cases.
struct StoredPlaces {
    std::vector<campaign::Place> places;
    std::vector<campaign::CaseHash> hashes;
    std::vector<CaseState> states;
};

/// Damage in the database.
struct Damage {
    std::string kind;        ///< "case", "table" or "file"
    std::string case_id;     ///< of a case
    std::string campaign;    ///< one or several; empty: none
    std::string observable;  ///< if only one observable is damaged
    std::string what;        ///< description
};

class Store {
public:
    enum class Mode { create, read };
    /// Kind of disk. A network disk gets a rollback journal instead of a write-ahead log. With `found_out`, a network
    /// disk (by statfs(2)) is refused.
    enum class Disk { found_out, local, network };
    /// create: makes the file and its schema if absent, and takes the writer's lock. The first transaction that writes
    /// updates an older schema. A second
    /// writer is refused with a sentence that names the first. read: changes neither content nor schema. Throws
    /// SystemError, or InputError if the file is no grainsweep database.
    Store(const std::filesystem::path& file, Mode mode, Disk disk = Disk::found_out);
    /// Reads a database that a run may continue; empty: there is none, or the run that made it was killed before it
    /// wrote.
    [[nodiscard]] static std::optional<Store> read_if_begun(const std::filesystem::path& file);
    ~Store();
    Store(Store&&) noexcept;
    Store& operator=(Store&&) noexcept;

    /// Stores or extends campaign and cases, makes its view, and closes attempts of a dead main program as abandoned.
    /// Repeating it has no effect. Returns the state of each case, in the given order. Not inside group().
    ///
    /// Throws InputError with both values if scene, revision, default, factor set, range, fixed value, condition,
    /// seed, kind of design, scramble or first index differ under the same name. Another size of a design that is not
    /// extensible (latin_hypercube, levels of a lattice) throws, too. More points or replicates extend the campaign. A
    /// smaller extent is accepted, removes nothing, and is stored beside the larger one (CampaignRecord). New levels of
    /// a factor of a lattice renumber the points: new places replace the old ones, and every answer is kept and stays
    /// in the view. Convergence is then judged anew, as after another rule or more replicates. A list can only grow at
    /// its end.
    ///
    /// At most `at_once` new places are entered; enrol_more() enters the others, so that a long campaign can begin
    /// early. The next run adds places that are missing when the program ends.
    std::vector<CaseState> enrol(const campaign::Campaign& campaign, const campaign::Cases& cases,
                                 const Provenance& provenance,
                                 std::size_t at_once = std::numeric_limits<std::size_t>::max());
    /// Returns whether places of the campaign enrolled last are left.
    [[nodiscard]] bool enrols() const;
    /// Enters up to `places` of them; they are on disk when it returns. Not inside group().
    void enrol_more(std::size_t places);

    /// Returns a sentence on each damage found by the last enrol and its treatment.
    [[nodiscard]] const std::vector<std::string>& notes() const;

    /// Throws SystemError if the file was moved, deleted or replaced since it was opened; group() does, too.
    void require_in_place() const;
    /// Returns whether another Store, of any process, has the lock of the writer.
    [[nodiscard]] bool is_being_written() const;

    /// Checks every row, then stores a checksum of the file, so that an unchanged file needs no further check. Throws
    /// SystemError with damage that occurred during the run. Does nothing if there was damage before.
    void remember_file();

    /// Origin of results. The rate of a run counts those that it computed.
    enum class Origin { computed, imported };
    /// Runs `writes` in one durable transaction: on disk when it returns, absent when it throws.
    void group(const std::function<void()>& writes, Origin origin = Origin::computed);
    // Inside group():
    /// Stores the begin of an attempt. Throws std::logic_error for an unknown case, or one with a later attempt. If the
    /// case is left to enrol_more(), all remaining places are entered first. `computer`: program and machine; all empty
    /// if unknown.
    void begin(const campaign::Attempt& attempt, const campaign::Computer& computer = {});
    /// Stores the result of an attempt. An answer (completed, skipped, unstable, rejected) replaces an earlier answer;
    /// an attempt without an answer does not. Returns false for a stale result, which is dropped: its attempt is not
    /// the case's latest, or is already closed. NaN is stored as NULL; a scalar NaN is not stored. Throws
    /// std::logic_error for an observable that the scene has not declared.
    bool finish(const campaign::CaseResult& result);
    void record(std::string_view campaign, const ConvergenceRow& row);
    /// Deletes the recorded checks, and the points at which the campaign stopped.
    void forget_checks(std::string_view campaign);
    /// Stores the points at which the campaign converged and stopped; empty: it continues.
    void stop(std::string_view campaign, std::optional<std::int64_t> points);
    /// Stores that the cases of a campaign were imported into another one and belong to no design.
    void mark_imported(std::string_view campaign, std::string_view into);

    // Queries. Queries of results check the checksums, once per Store, and throw SystemError with the damage; status,
    // places, attempts and query do not.
    [[nodiscard]] std::vector<CampaignRecord> campaigns() const;
    /// Returns the names of a campaign's factors in the order of its design's dimensions; empty if there is no campaign
    /// of this name.
    [[nodiscard]] std::vector<std::string> factor_order(std::string_view campaign) const;
    /// Returns the stored campaign of this name, if there is one. Throws InputError like enrol() if it differs.
    [[nodiscard]] std::optional<CampaignRecord> stored(const campaign::Campaign& campaign) const;
    /// Returns how many of these cases are settled, by any campaign.
    [[nodiscard]] std::int64_t settled(const campaign::Cases& cases) const;
    [[nodiscard]] bool is_settled(std::string_view case_id) const;
    [[nodiscard]] StoredPlaces placement(std::string_view campaign) const;
    /// Returns the case of an id or its beginning. Throws InputError if several cases match.
    [[nodiscard]] std::optional<campaign::Case> find_case(std::string_view id_or_prefix) const;
    /// Returns the program of a scene, with the contents of its files; empty for other scenes, or if the database has
    /// no programs. Throws SystemError if it is damaged.
    [[nodiscard]] std::shared_ptr<const campaign::Program> program(std::string_view scene) const;
    /// Returns the files of the campaigns of a case.
    [[nodiscard]] std::vector<StoredFile> files_of(std::string_view case_id) const;
    /// Registers the stored contents of the files of a case in this process; they have precedence over the files at
    /// their paths. Throws SystemError if they are damaged.
    void enter_files_of(const campaign::Case& question) const;
    [[nodiscard]] std::vector<LoggedAttempt> attempts(std::string_view case_id) const;
    [[nodiscard]] std::vector<CasePlace> places(std::string_view case_id) const;
    /// Returns the answer of a case, or the result of its last attempt if there is none.
    [[nodiscard]] std::optional<campaign::CaseResult> result(std::string_view case_id) const;
    /// Returns one scalar at all places of the campaign's design, ordered by (point, replicate).
    [[nodiscard]] std::vector<PlacedValue> values(std::string_view campaign, std::string_view observable) const;
    /// Returns the same for a series or profile at one place along it: time, or bin at the last time. Values are linear
    /// between two samples, whatever their stored order. Several samples at one place are averaged. NaN outside all
    /// samples.
    [[nodiscard]] std::vector<PlacedValue> values_along(std::string_view campaign, std::string_view observable,
                                                        double at) const;
    /// Returns the first and last place of every curve of an observable.
    [[nodiscard]] std::vector<CurveExtent> curve_extents(std::string_view campaign, std::string_view observable) const;
    [[nodiscard]] std::vector<ConvergenceRow> convergence(std::string_view campaign, std::string_view observable) const;
    /// Returns one row per campaign with these columns:
    ///
    ///   campaign, scene, cases, one count per outcome
    ///   waiting     cases without an outcome
    ///   stopped_at
    ///   rate        answers per second of the last run
    ///   time_left   s, at this rate; NULL: unknown
    ///   candidates  points of the design
    ///   dropped     candidates that the `where` clause excludes
    ///   points      the other candidates
    ///   replicates
    ///   finished    cases with an outcome other than abandoned
    ///   asked_points, asked_replicates   requested by the last run (points: candidates)
    ///   imported    cases whose answer was computed elsewhere (`grainsweep import`)
    [[nodiscard]] Table status() const;
    /// Returns the number of cases at places of the campaign whose answer was computed elsewhere.
    [[nodiscard]] std::int64_t imported_cases(std::string_view campaign) const;
    /// Returns the statement behind the campaign's view, as this program writes it. The stored view may be anybody's,
    /// and endless.
    [[nodiscard]] std::string rows_of(std::string_view campaign) const;
    /// Runs one statement of read-only SQL, with SQLite's functions and the aggregates of aggregates.hpp. Anything else
    /// throws InputError with SQLite's message, the existing names and the nearest one.
    [[nodiscard]] Table query(std::string_view sql) const;
    /// Limits of a query that returns its rows one by one, with bounded memory.
    struct QueryLimits {
        double seconds = 0;      ///< of processor time; 0: no limit
        std::int64_t bytes = 0;  ///< memory of SQLite; 0: no limit
    };
    void query(std::string_view sql, const QueryLimits& limits,
               const std::function<void(const std::vector<std::string>& columns)>& begin,
               const std::function<void(const std::vector<Table::Cell>& row)>& each) const;
    /// Limits the processor time of all statements from now on, s; `ended` is asked often and stops them, too.
    void limit(double seconds, std::function<bool()> ended) const;
    /// Writes the canonical text of all results, line by line without line breaks. It has no times, attempts or hosts,
    /// so equal results give equal texts. dump.cpp describes its form.
    void dump(const std::function<void(std::string_view line)>& sink) const;

    /// Checks the whole database: every checksum, and every id from the stored inputs. Returns the damage; empty: none.
    [[nodiscard]] std::vector<Damage> verify() const;
    /// Returns whether the file has checksums. An older file gets them in the next run.
    [[nodiscard]] bool has_checksums() const;

    struct Impl;  ///< defined for the files of this folder only

private:
    std::unique_ptr<Impl> impl_;
};

}  // namespace grainsweep::store
