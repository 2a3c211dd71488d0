// Conversion of SQLite's result codes to exceptions with a sentence. Internal to the store.
#pragma once

#include <chrono>
#include <string>

struct sqlite3;

namespace grainsweep::store {

/// Longest time that a statement waits for another process to unlock the file.
inline constexpr std::chrono::milliseconds patience = std::chrono::seconds(30);

/// Advice for a damaged file. `.recover` of sqlite3 is missing in some builds; Debian 12's writes no row. `.dump`
/// continues after damaged parts but ends with a rollback, which `sed` replaces.
inline constexpr const char* how_to_copy_out =
    "what is readable can be copied out with `sqlite3 FILE .dump | sed 's/^ROLLBACK;.*/COMMIT;/' | sqlite3 COPY`";

/// Returns "database 'a.db'", or "the database" if it has no file.
[[nodiscard]] std::string shown_file(sqlite3* database);
/// Throws the exception for a result code.
[[noreturn]] void fail(sqlite3* database, int code);
/// Throws the exception unless the code is SQLITE_OK.
void check(sqlite3* database, int code);

}  // namespace grainsweep::store
