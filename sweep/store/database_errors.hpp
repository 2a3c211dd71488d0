// What SQLite's result codes mean, as exceptions with a sentence. Internal to database.
#pragma once

#include <chrono>
#include <string>

struct sqlite3;

namespace grainsweep::store {

/// How long a statement waits for another process to let go of the file.
inline constexpr std::chrono::milliseconds patience = std::chrono::seconds(30);

/// "database 'a.db'", "the database" where it has no file.
[[nodiscard]] std::string shown_file(sqlite3* database);
/// Turns a result code into the exception and the sentence it deserves.
[[noreturn]] void fail(sqlite3* database, int code);
/// The same unless the code is SQLITE_OK.
void check(sqlite3* database, int code);

}  // namespace grainsweep::store
