// Shared state of the store's files: the open database and data kept between calls.
#pragma once

#include "sweep/campaign/identity.hpp"
#include "sweep/store/database.hpp"
#include "sweep/store/file_checksum.hpp"
#include "sweep/store/moment.hpp"
#include "sweep/store/placing.hpp"
#include "sweep/store/soundness.hpp"
#include "sweep/store/store.hpp"
#include "sweep/store/writer_lock.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace grainsweep::store {

/// Attempt that has begun and has no outcome.
struct OpenAttempt {
    std::int64_t number = 0, key = 0, revision = 0, provenance = 0, computer = 0;
    std::string scene, started;
    std::optional<campaign::Outcome> before;  ///< outcome of the case
};

struct Store::Impl {
    using Keys = std::map<std::string, std::int64_t, std::less<>>;  ///< name -> key

    Impl(std::filesystem::path path, std::optional<WriterLock> held, Connection connection)
        : file(std::move(path)), db(std::move(connection)), lock(std::move(held)) {}

    std::filesystem::path file;
    Connection db;
    std::optional<WriterLock> lock;  ///< empty: opened for reading; it ends before the connection

    std::optional<std::int64_t> provenance;  ///< of this run, once a campaign is enrolled
    std::int64_t provenance_campaign = 0;
    RunClock run_clock;              ///< of provenance: its start and its last result
    std::optional<Placing> placing;  ///< of the campaign enrolled last, until all its places are entered
    bool dead_attempts_closed = false;
    bool in_group = false;
    bool sound = false;              ///< checked since the last write: stored data is undamaged
    bool as_remembered = false;      ///< the whole file was undamaged when opened for writing, by its checksum
    PageHashes pages_then;           ///< its pages at that time; empty otherwise
    std::int64_t version = 0;        ///< data_version() at that time, to detect later writes of other programs
    bool whole = false;              ///< the whole file was undamaged at the last enrol
    std::vector<std::string> notes;  ///< damage found by the last enrol, and its treatment
    std::int64_t settled_in_group = 0;
    std::map<std::pair<std::string, std::int64_t>, Keys> observables;  ///< (scene, revision) -> keys
    std::map<campaign::Computer, std::int64_t> computers;
    /// Some attempts begun by this store; others are looked up.
    std::unordered_map<campaign::CaseId, OpenAttempt> open;

    /// Returns whether the file has the schema of an older program.
    [[nodiscard]] bool is_older() const;
    /// Brings an older file to the newest schema. Inside a transaction of something that is written: a question that
    /// is refused leaves the file to the older program.
    void bring_up_to_date();
    [[nodiscard]] std::int64_t data_version() const;
    void require_writer() const;
    void require_group() const;
    /// Returns whether the file has the columns of migration 003.
    [[nodiscard]] bool keeps_extents() const;
    /// Throws SystemError if another file is now at the path.
    void require_in_place() const;
    /// Throws SystemError with the first damage in the data; checked once.
    void require_sound();
    /// Checks every row, independent of the file's checksum. Returns false if rows belong to no case.
    [[nodiscard]] bool check_rows() const;
    /// Does the same with a second connection, which sees only what is committed.
    [[nodiscard]] bool check_rows_on_two_cores() const;
    [[nodiscard]] bool check_contents() const;
    /// Checks the tables of described_tables alone.
    [[nodiscard]] bool check_descriptions() const;
    /// Checks one case.
    void require_sound(std::int64_t key);
    void refuse_damage(const std::vector<DamagedTable>& tables, const std::vector<DamagedCase>& cases) const;
    /// Returns the key of a campaign. Throws InputError with the nearest name if there is none.
    [[nodiscard]] std::int64_t campaign_key(std::string_view name) const;
    /// Returns the key of an observable. Throws std::logic_error if the scene has not declared it.
    [[nodiscard]] std::int64_t observable_key(const std::string& scene, std::int64_t revision, std::string_view name);
    [[nodiscard]] std::int64_t computer_key(const campaign::Computer& computer);
    /// Takes an open attempt; empty if the attempt is not the case's latest, or has an outcome. Throws std::logic_error
    /// for an unknown case.
    [[nodiscard]] std::optional<OpenAttempt> take_open(const campaign::Attempt& attempt);
};

/// Tables that every run writes, and that are small.
inline constexpr std::array<std::string_view, 8> described_tables = {
    "campaign",         "provenance",  "parameter",      "observable",
    "attempt_computer", "convergence", "table_checksum", "file_checksum"};

/// Columns of `campaign` with the identity, and the identity read from them, beginning at column `first`.
[[nodiscard]] std::string identity_columns(const Connection& db);
inline constexpr int identity_column_count = 11;
[[nodiscard]] campaign::Identity identity_at(const Rows& rows, int first);
/// Stores the identity of a campaign that may have grown.
void store_identity(Connection& db, std::int64_t campaign_key, const campaign::Identity& identity);
/// Adds the JSON of every campaign of an older database, and its checksum.
void resolve_campaigns(Connection& db);

/// Returns the columns candidates, asked_candidates, asked_replicates of campaign g. An older database has none; the
/// placed numbers replace them.
[[nodiscard]] std::string extent_columns(bool kept);

/// Stored campaign of a name.
struct KnownCampaign {
    std::int64_t key = 0;
    campaign::Identity identity;
};
[[nodiscard]] std::optional<KnownCampaign> known_campaign(const Connection& db, std::string_view name);
/// Returns the stored campaign; empty if it is new. Throws InputError if the stored campaign of this name differs.
[[nodiscard]] std::optional<KnownCampaign> match_campaign(const Store::Impl& archive,
                                                          const campaign::Campaign& campaign);

/// Returns the key of a scalar, or of a series or profile, of a campaign. Throws InputError with the nearest name if
/// there is none.
[[nodiscard]] std::int64_t measured_key(const Connection& db, std::int64_t campaign_key, std::string_view campaign,
                                        std::string_view observable, bool scalar);

[[nodiscard]] CaseState stored_state(const Connection& db, std::int64_t key);
/// Checks every case of the file, removes damaged answers of `cases`, and updates their states. Returns whether all
/// other cases are undamaged.
[[nodiscard]] bool ask_damaged_again(Store::Impl& archive, const campaign::Cases& cases,
                                     const std::vector<DeclaredParameter>& parameters, KnownCases& known);

/// Stores the places of an enrolled campaign if its places do not simply extend the stored ones. Throws InputError
/// if stored places would leave the campaign, SystemError for a part of a damaged design.
void place_anew(Store::Impl& archive, const campaign::Campaign& campaign, std::int64_t campaign_key,
                const campaign::Cases& cases, const Placing& placing);
/// Removes verdicts on other places or by another rule.
void forget_convergence(Connection& db, std::int64_t campaign_key);

// programs.cpp
[[nodiscard]] bool has_programs(const Connection& db);
/// Registers the undamaged programs of the database in this process.
void enter_programs(const Connection& db);
/// Stores the program of a campaign and the contents of its files; does nothing for the solver's scenes.
void store_program(Connection& db, const campaign::Campaign& campaign);
/// Stores the facts of the system and the program about an attempt.
void store_program_facts(Connection& db, std::int64_t key, std::int64_t number, const campaign::ProgramFacts& facts);
[[nodiscard]] std::map<std::int64_t, campaign::ProgramFacts> program_facts(const Connection& db, std::int64_t key);
/// Returns a sentence on each damaged program.
[[nodiscard]] std::vector<std::string> damaged_programs(const Connection& db);

// machines.cpp
/// Registers the undamaged machines of the database in this process.
void enter_machines(const Connection& db);
/// Stores the machine of a campaign and the contents of its files; does nothing for other scenes.
void store_machine(Connection& db, const campaign::Campaign& campaign);
/// Returns a sentence on each damaged machine.
[[nodiscard]] std::vector<std::string> damaged_machines(const Connection& db);

// imports.cpp
/// Stores where the result of an attempt comes from.
void store_import(Connection& db, std::int64_t key, std::int64_t number, const campaign::ImportedLine& line);
/// Returns the origins of the attempts of a case that were computed elsewhere, by number.
[[nodiscard]] std::map<std::int64_t, campaign::ImportedLine> imported_lines(const Connection& db, std::int64_t key);
/// Returns the names of the campaigns into which the cases of others were imported, by the key of the other.
[[nodiscard]] std::map<std::int64_t, std::string> imported_campaigns(const Connection& db);
/// Returns an SQL expression: how many cases of a campaign, whose key is an expression, were computed elsewhere.
[[nodiscard]] std::string count_of_imports(const Connection& db, std::string_view campaign);
/// Returns a sentence on each damaged origin.
[[nodiscard]] std::vector<std::string> damaged_imports(const Connection& db);

// files.cpp
/// Stores the files that a campaign uses and their contents. Throws InputError if one has changed since it was read.
void store_files(Connection& db, std::int64_t campaign_key, const campaign::Campaign& campaign);
/// Returns a sentence on each damaged file.
[[nodiscard]] std::vector<std::string> damaged_files(const Connection& db);

/// Creates or renews the view with the campaign's name. If a view of the program was dropped or altered, all are
/// renewed.
void make_views(Store::Impl& archive, const campaign::Campaign& campaign, std::int64_t campaign_key);

}  // namespace grainsweep::store
