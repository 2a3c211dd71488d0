// Opening the archive, and groups of writes.
#include "sweep/store/store.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/store/aggregates.hpp"
#include "sweep/store/archive.hpp"
#include "sweep/store/database_errors.hpp"
#include "sweep/store/file_checksum.hpp"
#include "sweep/store/moment.hpp"
#include "sweep/store/schema.hpp"
#include "sweep/store/soundness.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <stdexcept>

namespace grainsweep::store {

using campaign::InputError;

namespace {

// A larger file would be read for longer than the checks of a run take.
constexpr std::int64_t most_remembered_bytes = std::int64_t{8} << 30U;
constexpr std::int64_t application = 0x67737770;  // "gswp" in the file's header: application_id

std::int64_t pragma(const Connection& db, std::string_view name) {
    auto statement = db.prepare(fmt::format("PRAGMA {}", name));
    return statement.step() ? statement.get<std::int64_t>(0) : 0;
}

std::string host_name() {
    std::array<char, 256> name{};
    return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "?";
}

std::uint32_t big_endian(const char* bytes) {
    std::uint32_t value = 0;
    for (int i = 0; i < 4; ++i) value = value << 8U | static_cast<unsigned char>(bytes[i]);
    return value;
}

[[noreturn]] void refuse_stranger(const std::filesystem::path& file) {
    throw InputError(fmt::format("'{}' is a database of another program, not grainsweep's.", file.string()));
}

/// A file that never was SQLite's, or is another program's, is a wrong question; one whose header is gone is damage.
/// Decided by the header alone, before a lock or a journal is made beside a foreign file.
void check_header(const std::filesystem::path& file) {
    constexpr std::size_t header_bytes = 100;
    const std::string seen = beginning_of(file, header_bytes);
    if (seen.empty()) return;
    if (seen.starts_with(std::string_view("SQLite format 3\0", 16))) {
        // https://www.sqlite.org/fileformat.html, 1.3: schema cookie at 40 (0: no table yet), application id at 68
        if (seen.size() == header_bytes && big_endian(&seen[40]) != 0 && big_endian(&seen[68]) != application)
            refuse_stranger(file);
        return;
    }
    if (seen.front() == '\0')
        throw SystemError(fmt::format("database '{}': damaged, its header is gone", file.string()));
    throw InputError(fmt::format("'{}' is not a grainsweep database.", file.string()));
}

void check_readable(const std::filesystem::path& file) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored))
        throw InputError(fmt::format("there is no database '{}'.", file.string()));
    if (!std::filesystem::is_regular_file(file, ignored))
        throw InputError(fmt::format("'{}' is not a file.", file.string()));
    check_header(file);
}

/// Version of the schema in the file; 0: nothing there yet.
std::int64_t schema_version(const Connection& db, const std::filesystem::path& file) {
    const std::int64_t version = pragma(db, "user_version");
    const std::int64_t id = pragma(db, "application_id");
    auto objects = db.prepare("SELECT count(*) FROM sqlite_schema");
    const bool empty = objects.step() && objects.get<std::int64_t>(0) == 0;
    if (version == 0 && id == 0 && empty) return 0;
    if (id != application || version < 1) refuse_stranger(file);
    const auto known = static_cast<std::int64_t>(schema_migrations().size());
    if (version > known) {
        throw InputError(fmt::format("'{}' was written by a newer grainsweep (schema {}, this one knows {}).",
                                     file.string(), version, known));
    }
    return version;
}

/// The file may be anybody's. A view in the place of a table could be read without end, a column that is computed could
/// answer anything.
void check_tables(const Connection& db, const std::filesystem::path& file) {
    constexpr std::array tables = {"campaign",      "provenance",       "parameter",       "observable",
                                   "sim_case",      "case_input",       "attempt",         "observation",
                                   "campaign_case", "convergence",      "table_checksum",  "file_checksum",
                                   "program",       "attempt_computer", "program_content", "attempt_program",
                                   "machine",       "campaign_file",    "attempt_import",  "campaign_import"};
    constexpr std::size_t of_the_first_version = 10;
    const auto refuse = [&](std::string_view what) {
        throw SystemError(fmt::format("database '{}': not as this program made it: {}", file.string(), what));
    };
    for (std::size_t k = 0; k < tables.size(); ++k) {
        auto objects = db.prepare("SELECT type, rootpage FROM sqlite_schema WHERE name = ?1 COLLATE NOCASE");
        objects.bind(1, tables[k]);
        if (!objects.step()) {
            if (k < of_the_first_version) refuse(fmt::format("it has no table {}", tables[k]));
            continue;
        }
        if (objects.get<std::string_view>(0) != "table" || objects.get<std::int64_t>(1) == 0)
            refuse(fmt::format(
                "{} is a {}", tables[k],
                objects.get<std::string_view>(0) == "table" ? "virtual table" : objects.get<std::string_view>(0)));
        auto columns = db.prepare(fmt::format("PRAGMA table_xinfo({})", tables[k]));
        constexpr int hidden = 6;  // of the row of a column; not 0: computed
        while (columns.step())
            if (columns.get<std::int64_t>(hidden) != 0)
                refuse(fmt::format("column {} of table {} is computed", columns.get<std::string_view>(1), tables[k]));
    }
}

/// Numbers that no run writes, of a file without checksums: with them they would become the truth.
void refuse_impossible(const Connection& db, const std::filesystem::path& file) {
    for (const auto& one : damaged_numbers(db))
        throw SystemError(fmt::format("database '{}': damaged: table {}: {}", file.string(), one.name, one.what));
}

/// Brings the file to the newest schema. Inside a transaction.
void migrate(Connection& db, const std::filesystem::path& file) {
    constexpr std::size_t first_with_resolved = 12;  // results_schema/012_resolved.sql
    const auto migrations = schema_migrations();
    const auto seen = static_cast<std::size_t>(schema_version(db, file));
    const bool unprotected = !has_checksums(db);
    const bool views_as_written = damaged_views(db).empty();
    for (const auto migration : migrations.subspan(seen)) db.execute(migration);
    db.execute(schema_views());
    if (seen < first_with_resolved) resolve_campaigns(db);
    // A migration that changes data with a checksum renews the checksum itself. Renewing it here would hide damage.
    if (unprotected)
        renew_everything(db);
    else if (views_as_written)
        renew_sum(db, "sqlite_schema");
    db.execute(fmt::format("PRAGMA user_version = {}; PRAGMA application_id = {}", migrations.size(), application));
}

/// Returns a text such as "process 4711 on node3 since 2026-01-01T12:00:00Z": the last run that the archive has
/// recorded. It is wrong if that run has ended and a new one has not recorded itself yet.
std::string holder_of(const std::filesystem::path& file) {
    try {
        const Connection db(file, Connection::Access::read);
        auto rows = db.ask("SELECT process, host, start FROM provenance ORDER BY provenance_id DESC LIMIT 1");
        if (!rows.next() || rows.is_null(0)) return {};
        const auto process = rows.get<std::int64_t>(0);
        const auto host = rows.get<std::string>(1);
        const bool ended = host == host_name() && kill(static_cast<pid_t>(process), 0) != 0 && errno == ESRCH;
        return ended ? "" : fmt::format("process {} on {} since {}", process, host, rows.get<std::string_view>(2));
    } catch (const SystemError&) {  // the file is not whole yet
        return {};
    }
}

[[noreturn]] void refuse_second_writer(const std::filesystem::path& file) {
    const std::string holder = holder_of(file);
    throw SystemError(fmt::format("database '{}': {} is writing to it; one run at a time", file.string(),
                                  holder.empty() ? "another run" : "the run of " + holder));
}

/// A name that SQLite, or a shell's habit, would read as something else than a file.
void check_name(const std::filesystem::path& file) {
    const std::string name = file.string();
    if (name == ":memory:") throw InputError("':memory:' is no database file: what a run stores must outlive it.");
    if (name.starts_with("file:"))
        throw InputError(fmt::format("'{}' is an address; a database is given by its file name.", name));
    if (name.empty()) throw InputError("a database needs a file name.");
}

/// The journal of a file lies beside one of its names and is not found beside another.
void refuse_several_names(const std::filesystem::path& file) {
    struct stat status {};
    if (stat(file.c_str(), &status) != 0 || status.st_nlink <= 1) return;
    throw InputError(
        fmt::format("'{}' has {} names (hard links): results written under one are not seen under another; remove the "
                    "other names, or copy the file.",
                    file.string(), status.st_nlink));
}

/// Pages, cells and the order of rows; an index that is not its table's would
/// hide a stored case.
void check_structure(const Connection& db, const std::filesystem::path& file) {
    for (const char* const what : {"integrity_check(sim_case)", "quick_check(campaign)", "quick_check(campaign_case)",
                                   "quick_check(case_input)", "quick_check(attempt)", "quick_check(observation)",
                                   "integrity_check(parameter)", "integrity_check(observable)"}) {
        auto rows = db.prepare(fmt::format("PRAGMA {}", what));
        while (rows.step()) {
            if (rows.get<std::string_view>(0) == "ok") continue;
            throw SystemError(
                fmt::format("database '{}': damaged ({}); `grainsweep verify {}` names all that is "
                            "damaged, and {}",
                            file.string(), rows.get<std::string_view>(0), file.string(), how_to_copy_out));
        }
    }
}

PageHashes pages_as_remembered_now(Connection& db, const std::filesystem::path& file) {
    const Transaction one_state(db, Transaction::Kind::read);
    return pages_as_remembered(db, file);
}

std::unique_ptr<Store::Impl> open_to_write(const std::filesystem::path& file, Store::Disk disk) {
    check_name(file);
    if (disk == Store::Disk::found_out) refuse_network(file, file_system_of(file));
    std::error_code ignored;
    if (std::filesystem::exists(file, ignored)) check_readable(file);
    Connection db(file, Connection::Access::write);
    auto lock = WriterLock::take(db.descriptor(), file);
    if (!lock) refuse_second_writer(file);
    refuse_several_names(file);
    const bool empty = schema_version(db, file) == 0;  // before anything is changed in a foreign file
    db.use(disk == Store::Disk::network ? Connection::Journal::rollback : Connection::Journal::write_ahead);
    const auto version = pragma(db, "data_version");
    auto pages_then = empty ? PageHashes() : pages_as_remembered_now(db, file);
    const bool as_remembered = !pages_then.empty();
    if (!empty) check_tables(db, file);
    if (!empty && !as_remembered) check_structure(db, file);
    if (!empty && !has_checksums(db)) refuse_impossible(db, file);
    if (empty) {
        Transaction transaction(db);
        migrate(db, file);
        transaction.commit();
    }
    enter_programs(db);
    enter_machines(db);
    auto archive = std::make_unique<Store::Impl>(file, std::move(lock), std::move(db));
    archive->as_remembered = as_remembered || empty;
    archive->pages_then = std::move(pages_then);
    archive->version = version;
    return archive;
}

std::unique_ptr<Store::Impl> open_to_read(const std::filesystem::path& file) {
    check_name(file);
    check_readable(file);
    Connection db(file, Connection::Access::read);
    const std::int64_t version = schema_version(db, file);
    if (version == 0)
        throw InputError(
            fmt::format("'{0}' is empty: no campaign has been run into it, or it was copied without its log, {0}-wal.",
                        file.string()));
    check_tables(db, file);
    // An older schema is read unchanged; the next run migrates it. So queries for data that a migration added first
    // check whether they exist (keeps_extents).
    enter_programs(db);
    enter_machines(db);
    return std::make_unique<Store::Impl>(file, std::nullopt, std::move(db));
}

}  // namespace

Store::Store(const std::filesystem::path& file, Mode mode, Disk disk)
    : impl_(mode == Mode::create ? open_to_write(file, disk) : open_to_read(file)) {
    add_statistics(impl_->db);
}
std::optional<Store> Store::read_if_begun(const std::filesystem::path& file) {
    if (!std::filesystem::exists(file)) return std::nullopt;
    check_name(file);
    check_readable(file);
    if (schema_version(Connection(file, Connection::Access::read), file) == 0) return std::nullopt;
    return Store(file, Mode::read);
}

Store::~Store() = default;
Store::Store(Store&&) noexcept = default;
Store& Store::operator=(Store&&) noexcept = default;

bool Store::Impl::is_older() const {
    return pragma(db, "user_version") < static_cast<std::int64_t>(schema_migrations().size());
}
void Store::Impl::bring_up_to_date() {
    if (is_older()) migrate(db, file);
}
std::int64_t Store::Impl::data_version() const {
    return pragma(db, "data_version");
}
void Store::Impl::require_writer() const {
    if (!lock) throw std::logic_error("the store was opened to read");
}
void Store::Impl::require_in_place() const {
    if (!db.has_moved()) return;
    throw SystemError(
        fmt::format("database '{}': it was moved, deleted or replaced while this run was writing to it; put it back, "
                    "with '{}-wal' beside it where there is one, and run again to resume",
                    file.string(), file.string()));
}
void Store::require_in_place() const {
    impl_->require_in_place();
}
bool Store::is_being_written() const {
    return WriterLock::is_taken(impl_->db.descriptor());
}
const std::vector<std::string>& Store::notes() const {
    return impl_->notes;
}

void Store::Impl::require_group() const {
    if (!in_group) throw std::logic_error("results are written inside Store::group()");
}

std::int64_t Store::Impl::observable_key(const std::string& scene, std::int64_t revision, std::string_view name) {
    Keys& keys = observables[{scene, revision}];
    if (keys.empty()) {
        auto rows =
            db.ask("SELECT name, observable_id FROM observable WHERE scene = ? AND revision = ?", scene, revision);
        while (rows.next()) keys.emplace(rows.get<std::string>(0), rows.get<std::int64_t>(1));
    }
    if (const auto found = keys.find(name); found != keys.end()) return found->second;
    throw std::logic_error(
        fmt::format("scene {} of revision {} has no observable '{}', and a case measured it", scene, revision, name));
}

std::int64_t Store::Impl::computer_key(const campaign::Computer& by) {
    const auto [found, fresh] = computers.try_emplace(by, 0);
    if (!fresh) return found->second;
    change_summed(db, "attempt_computer", [&] {
        db.run(
            "INSERT INTO attempt_computer (version, \"commit\", build, instruction_path, processor, host) "
            "VALUES (?, ?, ?, ?, ?, ?) ON CONFLICT DO NOTHING",
            by.version, by.commit, by.build, by.instruction_path, by.processor, by.host);
    });
    const auto key = db.value<std::int64_t>(
        "SELECT computer_id FROM attempt_computer WHERE (version, \"commit\", build, instruction_path, processor, "
        "host) "
        "= (?, ?, ?, ?, ?, ?)",
        by.version, by.commit, by.build, by.instruction_path, by.processor, by.host);
    if (!key) throw SystemError(fmt::format("database '{}': a row just written is not there", file.string()));
    return found->second = *key;
}

void Store::remember_file() {
    impl_->require_writer();
    if (impl_->in_group) throw std::logic_error("the file is remembered inside a group");
    if (!impl_->whole || impl_->is_older() || enrols() || impl_->db.file_bytes() > most_remembered_bytes) return;
    impl_->require_in_place();
    std::optional<SystemError> damage;
    const auto checked = [&](auto check) {
        return [this, &damage, check] {
            const Transaction one_state(impl_->db, Transaction::Kind::read);
            try {
                return check();
            } catch (const SystemError& found) {
                damage = found;
                return false;
            }
        };
    };
    try {
        store::remember_file(impl_->db, impl_->pages_then,
                             {checked([this] { return impl_->check_rows_on_two_cores(); }), described_tables,
                              checked([this] { return impl_->check_descriptions(); })});
        impl_->pages_then.clear();  // a later call sums what was written since, too
    } catch (const SystemError&) {  // all results are on disk; the next to open the file checks its rows
    }
    if (damage) throw *damage;
}

void Store::group(const std::function<void()>& writes, Origin origin) {
    impl_->require_writer();
    if (impl_->in_group) throw std::logic_error("a group inside a group");
    struct Membership {  // whatever happens, the group ends here
        Impl& impl;
        bool committed = false;
        explicit Membership(Impl& of) : impl(of) {
            impl.in_group = true;
            impl.settled_in_group = 0;
        }
        Membership(const Membership&) = delete;
        ~Membership() {
            impl.in_group = false;
            if (committed) return;  // else forget rows that were rolled back
            impl.computers.clear();
            impl.placing.reset();
            impl.open.clear();
        }
    } membership(*impl_);
    impl_->require_in_place();
    Transaction transaction(impl_->db);
    impl_->bring_up_to_date();
    writes();
    if (impl_->settled_in_group > 0) {
        impl_->db.run(
            "UPDATE provenance SET settled = settled + ?1, last_result = iif(?2, ?3, last_result) "
            "WHERE provenance_id = ?4",
            impl_->settled_in_group, origin == Origin::computed, impl_->run_clock.now(), impl_->provenance);
    }
    transaction.commit();
    impl_->sound = false;
    membership.committed = true;
    impl_->require_in_place();  // else the data were written to another file than the one read later
}

}  // namespace grainsweep::store
