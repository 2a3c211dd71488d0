// What a run has stored so far: its database is read while it runs, without starting a program.
#pragma once

#include "tests/support/process.hpp"

#include <cstdint>
#include <filesystem>
#include <string>

namespace grainsweep::tests {

/// The number that the query returns; -1 while the database cannot answer it.
[[nodiscard]] std::int64_t number_in(const std::filesystem::path& database, const std::string& sql);

/// Waits until the number is at least `least`, or the run is over.
void await_number(Process& run, const std::filesystem::path& database, const std::string& sql, std::int64_t least);
/// The same for the number of cases that have an outcome.
void await_settled(Process& run, const std::filesystem::path& database, std::int64_t cases);

}  // namespace grainsweep::tests
