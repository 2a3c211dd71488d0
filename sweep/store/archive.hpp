// What the files of the store share: the open database and what it remembers between calls.
#pragma once

#include "sweep/campaign/identity.hpp"
#include "sweep/store/database.hpp"
#include "sweep/store/moment.hpp"
#include "sweep/store/placing.hpp"
#include "sweep/store/soundness.hpp"
#include "sweep/store/store.hpp"
#include "sweep/store/writer_lock.hpp"

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

/// An attempt that has begun and has no outcome.
struct OpenAttempt {
    std::int64_t number = 0, key = 0, revision = 0, provenance = 0, computer = 0;
    std::string scene, started;
    std::optional<campaign::Outcome> before;  ///< outcome of the case
    bool stored = false;                      ///< false: its row is written with its outcome, or when the group ends
};

struct Store::Impl {
    using Keys = std::map<std::string, std::int64_t, std::less<>>;  ///< name -> key

    Impl(std::filesystem::path path, std::optional<WriterLock> held, Connection connection)
        : file(std::move(path)), lock(std::move(held)), db(std::move(connection)) {}

    std::filesystem::path file;
    std::optional<WriterLock> lock;  ///< none: opened to read
    Connection db;

    std::optional<std::int64_t> provenance;  ///< of this run, once a campaign is enrolled
    std::int64_t provenance_campaign = 0;
    RunClock run_clock;              ///< of provenance: its start and its last result
    std::optional<Placing> placing;  ///< of the campaign enrolled last, while some of its places are not entered
    bool dead_attempts_closed = false;
    bool in_group = false;
    bool sound = false;              ///< checked since this store last wrote: what is read is what was written
    bool as_remembered = false;      ///< so was the whole file when it was opened to write, by its checksum
    std::int64_t version = 0;        ///< then: data_version(), which tells whether another program has written since
    bool whole = false;              ///< everything in the file is sound, as of the last enrol
    std::vector<std::string> notes;  ///< damage met by the last enrol, and what became of it
    std::int64_t settled_in_group = 0;
    std::map<std::pair<std::string, std::int64_t>, Keys> observables;  ///< (scene, revision) -> keys
    std::map<campaign::Computer, std::int64_t> computers;
    /// Attempts begun by this store, as far as it remembers: what is not here is looked up.
    std::unordered_map<campaign::CaseId, OpenAttempt> open;
    /// Cases whose attempts began in this group. Most end in it too, and are then written once.
    std::vector<campaign::CaseId> begun;

    [[nodiscard]] std::int64_t data_version() const;
    void require_writer() const;
    void require_group() const;
    /// Whether the file has the columns of migration 003.
    [[nodiscard]] bool keeps_extents() const;
    /// Throws BrokenWorld where the file is no longer the one that was opened.
    void require_in_place() const;
    /// Throws BrokenWorld naming the first damage among all that is data; checked once.
    void require_sound();
    /// The same, of every row, whatever is remembered of the file. False where rows belong to no case.
    [[nodiscard]] bool check_rows() const;
    /// The same for one case.
    void require_sound(std::int64_t key);
    void require_order() const;
    void refuse_damage(const std::vector<DamagedTable>& tables, const std::vector<DamagedCase>& cases) const;
    /// Throws WrongQuestion with the nearest name where there is none.
    [[nodiscard]] std::int64_t campaign_key(std::string_view name) const;
    /// Throws std::logic_error for one that the scene has not declared.
    [[nodiscard]] std::int64_t observable_key(const std::string& scene, std::int64_t revision, std::string_view name);
    [[nodiscard]] std::int64_t computer_key(const campaign::Computer& computer);
    /// None where the attempt is not the case's latest, or has an outcome. Throws std::logic_error for an unknown case.
    [[nodiscard]] std::optional<OpenAttempt> take_open(const campaign::Attempt& attempt);
    /// Stores the open attempt of a case, unless it is stored. Throws std::logic_error where it has ended before.
    void store_open(const campaign::CaseId& id);
    void store_begun();
};

/// The columns of `campaign` that hold an identity, and what is read from them, the first at `first`.
inline constexpr std::string_view identity_columns =
    "name, scene, revision, seed, factors, fixed, condition, design, design_options, design_extent";
inline constexpr int identity_column_count = 10;
[[nodiscard]] campaign::Identity identity_at(const Rows& rows, int first);

/// candidates, asked_candidates, asked_replicates of campaign g; of an older archive, which keeps none, what is placed.
[[nodiscard]] std::string extent_columns(bool kept);

/// A stored campaign; none of that name.
struct KnownCampaign {
    std::int64_t key = 0;
    campaign::Identity identity;
};
[[nodiscard]] std::optional<KnownCampaign> known_campaign(const Connection& db, std::string_view name);
/// Throws WrongQuestion where the stored campaign of that name is another one; returns its key, none where it is
/// new.
[[nodiscard]] std::optional<std::int64_t> match_campaign(const Store::Impl& archive,
                                                         const campaign::Campaign& campaign);

/// The key of a scalar, or of a series or profile, of a campaign. Throws WrongQuestion with the nearest name where
/// there is none.
[[nodiscard]] std::int64_t measured_key(const Connection& db, std::int64_t campaign_key, std::string_view campaign,
                                        std::string_view observable, bool scalar);

[[nodiscard]] CaseState stored_state(const Connection& db, std::int64_t key);
/// Checks every case of the file, forgets damaged answers of these and brings their states up to date. Returns whether
/// all others are sound.
[[nodiscard]] bool ask_damaged_again(Store::Impl& archive, const campaign::Cases& cases,
                                     const std::vector<DeclaredParameter>& parameters, KnownCases& known);

/// Stores the places of an enrolled campaign whose placing does not simply add to what is there. Throws WrongQuestion
/// where that would take stored places out of the campaign, BrokenWorld for a part of a damaged design.
void place_anew(Store::Impl& archive, const campaign::Campaign& campaign, std::int64_t campaign_key,
                const campaign::Cases& cases, const Placing& placing);
/// The verdicts given so far were about other places, or by another rule.
void forget_convergence(Connection& db, std::int64_t campaign_key);

// programs.cpp
[[nodiscard]] bool has_programs(const Connection& db);
/// Makes the programs of the archive known to this process, as far as they are as written.
void enter_programs(const Connection& db);
/// Stores the program that answers a campaign, and the contents of its files; nothing where the solver does.
void store_program(Connection& db, const campaign::Campaign& campaign);
/// What the system and the program said of an attempt.
void store_program_facts(Connection& db, std::int64_t key, std::int64_t number, const campaign::ProgramFacts& facts);
[[nodiscard]] std::map<std::int64_t, campaign::ProgramFacts> program_facts(const Connection& db, std::int64_t key);
/// What of programs is not as it was written, a sentence each.
[[nodiscard]] std::vector<std::string> damaged_programs(const Connection& db);

// machines.cpp
/// Makes the machines of the archive known to this process, as far as they are as written.
void enter_machines(const Connection& db);
/// Stores the machine of a campaign, and the contents of its files; nothing where the scene is another one.
void store_machine(Connection& db, const campaign::Campaign& campaign);
/// Returns what of machines is not as it was written, a sentence each.
[[nodiscard]] std::vector<std::string> damaged_machines(const Connection& db);

// files.cpp
/// Stores the files that a campaign uses and their contents. Throws WrongQuestion where one has changed since it was
/// read.
void store_files(Connection& db, std::int64_t campaign_key, const campaign::Campaign& campaign);
/// Returns what of them is not as it was written, a sentence each.
[[nodiscard]] std::vector<std::string> damaged_files(const Connection& db);

/// Creates or renews the view that bears the campaign's name; where a view of ours was dropped or altered, all of them.
void make_views(Store::Impl& archive, const campaign::Campaign& campaign, std::int64_t campaign_key);

}  // namespace grainsweep::store
