// What SQLite's result codes mean, as exceptions with a sentence. Internal to the store.
#pragma once

#include <chrono>
#include <string>

struct sqlite3;

namespace grainsweep::store {

/// How long a statement waits for another process to let go of the file.
inline constexpr std::chrono::milliseconds patience = std::chrono::seconds(30);

/// What to do with a damaged file. sqlite3's `.recover` is not there in every build: Debian 12's writes no row. `.dump`
/// reads on behind what is damaged, and ends by undoing it all, which `sed` prevents.
inline constexpr const char* how_to_copy_out =
    "what is readable can be copied out with `sqlite3 FILE .dump | sed 's/^ROLLBACK;.*/COMMIT;/' | sqlite3 COPY`";

/// "database 'a.db'", "the database" where it has no file.
[[nodiscard]] std::string shown_file(sqlite3* database);
/// Turns a result code into the exception and the sentence it deserves.
[[noreturn]] void fail(sqlite3* database, int code);
/// The same unless the code is SQLITE_OK.
void check(sqlite3* database, int code);

}  // namespace grainsweep::store
