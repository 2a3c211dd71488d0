#include "sweep/store/database_errors.hpp"

#include "sweep/store/database.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <cstring>
#include <new>

namespace grainsweep::store {

std::string shown_file(sqlite3* database) {
    const char* file = database == nullptr ? nullptr : sqlite3_db_filename(database, "main");
    return file == nullptr || *file == '\0' ? "the database" : fmt::format("database '{}'", file);
}

void fail(sqlite3* database, int code) {
    const std::string words = database == nullptr ? sqlite3_errstr(code) : sqlite3_errmsg(database);
    const std::string file = shown_file(database);
    const auto cause = [&] {
        const int number = database == nullptr ? 0 : sqlite3_system_errno(database);
        return number == 0 ? words : fmt::format("{} ({})", words, std::strerror(number));
    };
    switch (code & 0xff) {
        case SQLITE_FULL:
            throw SystemError(fmt::format("{}: the disk is full; free some space and run again to resume", file));
        case SQLITE_BUSY:
        case SQLITE_LOCKED:
        case SQLITE_PROTOCOL:
            throw SystemError(fmt::format("{}: locked by another process for more than {} s", file,
                                          std::chrono::duration_cast<std::chrono::seconds>(patience).count()));
        case SQLITE_CORRUPT:
        case SQLITE_NOTADB:
        case SQLITE_FORMAT:
            throw SystemError(fmt::format("{}: damaged ({}); {}", file, words, how_to_copy_out));
        case SQLITE_IOERR:
            throw SystemError(fmt::format("{}: reading or writing failed: {}", file, cause()));
        case SQLITE_CANTOPEN:
        case SQLITE_PERM:
            throw SystemError(fmt::format("{}: cannot be opened: {}", file, cause()));
        case SQLITE_READONLY:
            throw SystemError(fmt::format("{}: is not writable: {}", file, cause()));
        case SQLITE_NOMEM:
            if (sqlite3_hard_heap_limit64(-1) > 0)
                throw StatementLimit(
                    fmt::format("it needs more than {} MiB of memory", sqlite3_hard_heap_limit64(-1) >> 20), file);
            throw std::bad_alloc();
        case SQLITE_INTERRUPT:
            throw StatementLimit("it takes too long", file);
        default:
            throw RefusedSql(words, file);
    }
}

void check(sqlite3* database, int code) {
    if (code != SQLITE_OK) fail(database, code);
}

}  // namespace grainsweep::store
