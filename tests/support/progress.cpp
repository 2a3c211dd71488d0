#include "tests/support/progress.hpp"

#include <sqlite3.h>

#include <chrono>
#include <thread>

namespace grainsweep::tests {

std::int64_t number_in(const std::filesystem::path& database, const std::string& sql) {
    sqlite3* db = nullptr;
    std::int64_t number = -1;
    if (sqlite3_open_v2(database.c_str(), &db, SQLITE_OPEN_READONLY, nullptr) == SQLITE_OK) {
        sqlite3_busy_timeout(db, 1000);
        sqlite3_stmt* statement = nullptr;
        if (sqlite3_prepare_v2(db, sql.c_str(), -1, &statement, nullptr) == SQLITE_OK &&
            sqlite3_step(statement) == SQLITE_ROW) {
            number = sqlite3_column_int64(statement, 0);
        }
        sqlite3_finalize(statement);
    }
    sqlite3_close(db);
    return number;
}

void await_number(Process& run, const std::filesystem::path& database, const std::string& sql, std::int64_t least) {
    while (run.running() && number_in(database, sql) < least) std::this_thread::sleep_for(std::chrono::milliseconds(2));
}

void await_settled(Process& run, const std::filesystem::path& database, std::int64_t cases) {
    await_number(run, database, "SELECT count(outcome) FROM sim_case", cases);
}

}  // namespace grainsweep::tests
