#include "sweep/store/database.hpp"

#include "sweep/store/database_errors.hpp"

#include <fmt/format.h>
#include <sqlite3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <mutex>
#include <set>
#include <stdexcept>
#include <system_error>
#include <vector>

namespace grainsweep::store {

namespace {

sqlite3* owner(sqlite3_stmt* statement) {
    return sqlite3_db_handle(statement);
}

sqlite3* open_handle(const char* name, int flags) {
    sqlite3* handle = nullptr;
    const int code = sqlite3_open_v2(name, &handle, flags | SQLITE_OPEN_NOMUTEX, nullptr);
    if (code == SQLITE_OK) return handle;
    const std::unique_ptr<sqlite3, int (*)(sqlite3*)> closing(handle, sqlite3_close_v2);
    const int number = handle == nullptr ? 0 : sqlite3_system_errno(handle);
    throw SystemError(fmt::format("database '{}': cannot be opened{}: {}", name,
                                  (flags & SQLITE_OPEN_CREATE) != 0 ? " to write" : "",
                                  number == 0 ? sqlite3_errstr(code) : std::strerror(number)));
}

/// Held while a file is opened, so that a new descriptor is that of this opening.
std::mutex& opening() {
    static std::mutex mutex;
    return mutex;
}

/// Returns the descriptors of this process that are open on the file.
std::set<int> descriptors_of(const std::filesystem::path& file) {
    std::set<int> found;
    struct stat wanted {};
    if (::stat(file.c_str(), &wanted) != 0) return found;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd", error)) {
        const int number = std::atoi(entry.path().filename().c_str());
        struct stat one {};
        if (::fstat(number, &one) == 0 && one.st_dev == wanted.st_dev && one.st_ino == wanted.st_ino)
            found.insert(number);
    }
    return found;
}

/// A file name as a URI, whatever characters it has.
std::string uri(const std::filesystem::path& file, std::string_view query) {
    std::string text = "file:";
    for (const char c : std::filesystem::absolute(file).string()) {
        const bool plain = (std::isalnum(static_cast<unsigned char>(c)) != 0) || std::strchr("/._-", c) != nullptr;
        if (plain) {
            text += c;
        } else {
            text += fmt::format("%{:02x}", static_cast<unsigned char>(c));
        }
    }
    return text.append("?").append(query);
}

}  // namespace

// --- Statement

void Statement::Finalize::operator()(sqlite3_stmt* statement) const {
    sqlite3_finalize(statement);
}

Statement::Statement(sqlite3* database, std::string_view sql) {
    sqlite3_stmt* handle = nullptr;
    const char* rest = nullptr;
    if (sql.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) throw RefusedSql("statement too long");
    check(database, sqlite3_prepare_v3(database, sql.data(), static_cast<int>(sql.size()), SQLITE_PREPARE_PERSISTENT,
                                       &handle, &rest));
    handle_.reset(handle);
    tail_ = sql.substr(static_cast<std::size_t>(rest - sql.data()));
}

void Statement::bind(int parameter, std::nullopt_t) {
    check(owner(handle_.get()), sqlite3_bind_null(handle_.get(), parameter));
}
void Statement::bind(int parameter, std::int64_t value) {
    check(owner(handle_.get()), sqlite3_bind_int64(handle_.get(), parameter, value));
}
void Statement::bind(int parameter, double value) {
    const int code = std::isnan(value) ? sqlite3_bind_null(handle_.get(), parameter)
                                       : sqlite3_bind_double(handle_.get(), parameter, value);
    check(owner(handle_.get()), code);
}
void Statement::bind(int parameter, std::string_view value) {
    const char* data = value.data() == nullptr ? "" : value.data();
    check(owner(handle_.get()),
          sqlite3_bind_text64(handle_.get(), parameter, data, value.size(), SQLITE_STATIC, SQLITE_UTF8));
}
void Statement::bind(int parameter, const Blob& value) {
    const char* data = value.bytes.data() == nullptr ? "" : value.bytes.data();
    check(owner(handle_.get()), sqlite3_bind_blob64(handle_.get(), parameter, data, value.bytes.size(), SQLITE_STATIC));
}
void Statement::bind(int parameter, const Value& value) {
    std::visit([&](const auto& held) { bind(parameter, held); }, value);
}

bool Statement::step() {
    const int code = sqlite3_step(handle_.get());
    if (code == SQLITE_ROW) return true;
    if (code == SQLITE_DONE) return false;
    fail(owner(handle_.get()), code);
}

void Statement::reset() {
    sqlite3_reset(handle_.get());
}  // repeats the error of the last step: already thrown

bool Statement::busy() const {
    return sqlite3_stmt_busy(handle_.get()) != 0;
}
bool Statement::read_only() const {
    return sqlite3_stmt_readonly(handle_.get()) != 0;
}
int Statement::parameters() const {
    return sqlite3_bind_parameter_count(handle_.get());
}
int Statement::columns() const {
    return sqlite3_column_count(handle_.get());
}
std::string Statement::column_name(int column) const {
    return sqlite3_column_name(handle_.get(), column);
}
bool Statement::is_null(int column) const {
    return sqlite3_column_type(handle_.get(), column) == SQLITE_NULL;
}
std::int64_t Statement::integer(int column) const {
    return sqlite3_column_int64(handle_.get(), column);
}
double Statement::real(int column) const {
    return is_null(column) ? std::numeric_limits<double>::quiet_NaN() : sqlite3_column_double(handle_.get(), column);
}
std::string_view Statement::text(int column) const {
    const auto* bytes = reinterpret_cast<const char*>(sqlite3_column_text(handle_.get(), column));
    return bytes == nullptr
               ? std::string_view{}
               : std::string_view(bytes, static_cast<std::size_t>(sqlite3_column_bytes(handle_.get(), column)));
}

std::string Statement::blob(int column) const {
    const auto* bytes = static_cast<const char*>(sqlite3_column_blob(handle_.get(), column));
    if (bytes == nullptr) return {};
    return {bytes, static_cast<std::size_t>(sqlite3_column_bytes(handle_.get(), column))};
}

SqlValue Statement::cell(int column) const {
    switch (sqlite3_column_type(handle_.get(), column)) {
        case SQLITE_NULL:
            return {};
        case SQLITE_INTEGER:
            return integer(column);
        case SQLITE_FLOAT:
            return real(column);
        case SQLITE_TEXT:
            return std::string(text(column));
        default:
            break;
    }
    const auto* bytes = static_cast<const unsigned char*>(sqlite3_column_blob(handle_.get(), column));
    std::string hexadecimal;
    for (int k = 0; k < sqlite3_column_bytes(handle_.get(), column); ++k)
        hexadecimal += fmt::format("{:02x}", bytes[k]);
    return hexadecimal;
}

Value Statement::value(int column) const {
    SqlValue held = cell(column);
    if (auto* whole = std::get_if<std::int64_t>(&held)) return *whole;
    if (auto* word = std::get_if<std::string>(&held)) return std::move(*word);
    return real(column);
}

// --- Connection

void Connection::Close::operator()(sqlite3* database) const {
    sqlite3_close_v2(database);
}

Connection::Connection(sqlite3* handle) : handle_(handle) {
    configure();
}

// SQLite keeps the descriptor of a closed connection while another one of this process has locks on the file, and gives
// it to the next connection. Then no descriptor is new, and a further one is opened.
void Connection::open(const std::filesystem::path& file, const std::string& name, int flags) {
    const std::lock_guard alone(opening());
    std::vector<std::unique_ptr<sqlite3, Close>> with_a_kept_one;
    for (descriptor_ = -1; descriptor_ < 0;) {
        const auto before = descriptors_of(file);
        if (with_a_kept_one.size() > before.size())
            throw SystemError(
                fmt::format("database '{}': its descriptor is not found in /proc/self/fd", file.string()));
        handle_.reset(open_handle(name.c_str(), flags));
        for (const int number : descriptors_of(file))
            if (!before.contains(number)) descriptor_ = number;
        if (descriptor_ < 0) with_a_kept_one.push_back(std::move(handle_));
    }
    entry_ = files::LockedFile(file);
}

Connection::Connection(const std::filesystem::path& file, Access access) {
    if (access == Access::write) {
        open(file, file.string(), SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE);
        if (sqlite3_db_readonly(handle_.get(), "main") != 0)
            throw SystemError(fmt::format("database '{}': cannot be opened to write: {}", file.string(),
                                          ::access(file.c_str(), W_OK) == 0 ? "read-only" : std::strerror(errno)));
        configure();
        return;
    }
    // SQLite opens to read only what the system lets it only read. Where it may write, the last reader to close removes
    // the write-ahead log and its shared memory, also those of a writer that died.
    open(file, file.string(), SQLITE_OPEN_READWRITE);
    configure();
    execute("PRAGMA query_only = ON");
    const auto waits = [&](const char* ending) {
        auto name = file;
        std::error_code none;
        const auto size = std::filesystem::file_size(name += ending, none);
        return !none && size > 0;
    };
    try {
        probe();
    } catch (const SystemError&) {
        const int code = sqlite3_extended_errcode(handle_.get());
        // A write-ahead database needs its shared-memory file beside it. Where that cannot be made and no journal
        // is waiting, there is no writer either.
        const bool closed_folder = (code & 0xff) == SQLITE_CANTOPEN || (code & 0xff) == SQLITE_READONLY;
        if (!closed_folder || waits("-wal") || waits("-journal")) throw;
        handle_.reset();
        open(file, uri(file, "immutable=1"), SQLITE_OPEN_READONLY | SQLITE_OPEN_URI);
        configure();
    }
}

Connection Connection::in_memory() {
    return Connection(open_handle(":memory:", SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE));
}

void Connection::probe() const {
    auto statement = prepare("SELECT count(*) FROM sqlite_schema");
    (void)statement.step();
}

void Connection::configure() {
    sqlite3* database = handle_.get();
    sqlite3_extended_result_codes(database, 1);
    sqlite3_busy_timeout(database, static_cast<int>(patience.count()));
    // A misspelt "name" must be an unknown column, not a word.
    sqlite3_db_config(database, SQLITE_DBCONFIG_DQS_DML, 0, nullptr);
    sqlite3_db_config(database, SQLITE_DBCONFIG_DQS_DDL, 0, nullptr);
    sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    // A foreign trigger would change the data that this program writes and later trusts.
    sqlite3_db_config(database, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
    sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
}

void Connection::use(Journal journal) {
    execute("PRAGMA synchronous = FULL; PRAGMA foreign_keys = ON; PRAGMA cache_size = -65536");
    const bool ahead = journal == Journal::write_ahead;
    auto statement = prepare(ahead ? "PRAGMA journal_mode = WAL" : "PRAGMA journal_mode = DELETE");
    const std::string got = statement.step() ? statement.get<std::string>(0) : "";
    if (got != (ahead ? "wal" : "delete")) {
        throw SystemError(fmt::format("{}: its journal could not be set to '{}' (it is '{}')",
                                      shown_file(handle_.get()), ahead ? "wal" : "delete", got));
    }
}

void Connection::execute(std::string_view script) {
    while (!script.empty()) {
        Statement statement(handle_.get(), script);
        script = statement.tail();
        if (!statement.valid()) continue;  // white space or a comment
        while (statement.step()) {
        }
    }
}

Statement& Connection::kept(std::string_view sql) const {
    if (const auto found = kept_.find(sql); found != kept_.end()) {
        if (found->second.busy()) throw std::logic_error(fmt::format("statement in use twice: {}", sql));
        return found->second;
    }
    return kept_.emplace(sql, Statement(handle_.get(), sql)).first->second;
}

std::int64_t Connection::last_row() const {
    return sqlite3_last_insert_rowid(handle_.get());
}
std::int64_t Connection::changes() const {
    return sqlite3_changes64(handle_.get());
}
bool Connection::has_moved() const {
    int moved = 0;
    return sqlite3_file_control(handle_.get(), "main", SQLITE_FCNTL_HAS_MOVED, &moved) == SQLITE_OK && moved != 0;
}
namespace {

sqlite3_file* file_behind(sqlite3* database) {
    sqlite3_file* file = nullptr;
    check(database, sqlite3_file_control(database, "main", SQLITE_FCNTL_FILE_POINTER, &file));
    return file;
}

[[noreturn]] void fail_reading(sqlite3* database, int code) {
    throw SystemError(fmt::format("{}: reading it failed ({})", shown_file(database), sqlite3_errstr(code)));
}

}  // namespace

std::int64_t Connection::file_bytes() const {
    sqlite3_file* file = file_behind(handle_.get());
    sqlite3_int64 bytes = 0;
    if (const int code = file->pMethods->xFileSize(file, &bytes); code != SQLITE_OK) fail_reading(handle_.get(), code);
    return bytes;
}

void Connection::read_file(std::int64_t offset, std::span<std::byte> into) const {
    sqlite3_file* file = file_behind(handle_.get());
    const int code = file->pMethods->xRead(file, into.data(), static_cast<int>(into.size()), offset);
    if (code != SQLITE_OK) fail_reading(handle_.get(), code);
}

std::string beginning_of(const std::filesystem::path& file, std::size_t most) {
    const std::lock_guard alone(opening());
    const std::unique_ptr<sqlite3, int (*)(sqlite3*)> handle(open_handle(file.c_str(), SQLITE_OPEN_READONLY),
                                                             sqlite3_close_v2);
    sqlite3_file* opened = file_behind(handle.get());
    sqlite3_int64 bytes = 0;
    int code = opened->pMethods->xFileSize(opened, &bytes);
    std::string text(static_cast<std::size_t>(std::min(bytes, static_cast<sqlite3_int64>(most))), '\0');
    if (code == SQLITE_OK && !text.empty())
        code = opened->pMethods->xRead(opened, text.data(), static_cast<int>(text.size()), 0);
    if (code != SQLITE_OK) fail_reading(handle.get(), code);
    return text;
}

bool Connection::in_transaction() const {
    return sqlite3_get_autocommit(handle_.get()) == 0;
}

// --- Transaction

Transaction::Transaction(Connection& connection, Kind kind) : connection_(&connection) {
    connection.run(kind == Kind::write ? "BEGIN IMMEDIATE" : "BEGIN");
}

Transaction::~Transaction() {
    if (connection_ == nullptr || !connection_->in_transaction()) return;  // a full disk may have rolled back already
    try {
        connection_->run("ROLLBACK");
    } catch (const std::exception&) {  // the file is rolled back when it is opened next
    }
}

void Transaction::commit() {
    connection_->run("COMMIT");
    connection_ = nullptr;
}

bool is_sql_word(std::string_view word) {
    return sqlite3_keyword_check(word.data(), static_cast<int>(word.size())) != 0;
}

std::string quoted_name(std::string_view name) {
    std::string text = "\"";
    for (const char c : name) text.append(c == '"' ? 2 : 1, c);
    return text += '"';
}

std::string quoted_text(std::string_view words) {
    std::string text = "'";
    for (const char c : words) text.append(c == '\'' ? 2 : 1, c);
    return text += '\'';
}

}  // namespace grainsweep::store
