// Checksum of a whole database file. Checking every row and index of a million cases takes seconds; summing the hashes
// of the pages takes a fraction of a second. The last run checked or wrote the whole file, so an unchanged file is
// undamaged.
//
// Not included are the page of the checksum itself and the parts of the first page that SQLite changes with it: the
// change counter (bytes 24 to 27), and its version (92 to 99);
// https://www.sqlite.org/fileformat.html
#pragma once

#include "sweep/store/database.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

namespace grainsweep::store {

/// Hash of every page of a file; empty: unknown.
using PageHashes = std::vector<std::uint64_t>;

/// Returns the hashes if the file has the same bytes as after remember_file(). Empty if it has not, or if this is
/// unknown: there is no checksum, or a write-ahead log is pending. Call it inside a transaction, at least for reading.
[[nodiscard]] PageHashes pages_as_remembered(const Connection& db, const std::filesystem::path& file);
/// Returns whether there are such hashes.
[[nodiscard]] bool is_as_remembered(const Connection& db, const std::filesystem::path& file);

/// Checks of the contents, which must read from the disk.
struct FileChecks {
    std::function<bool()> all_is_sound;
    std::span<const std::string_view> tables;  ///< small tables, which every run writes
    std::function<bool()> tables_are_sound;    ///< of these tables alone
};

/// Sums the file, checks its contents, then stores the sum. A byte that changes after the summing changes the sum. A
/// byte that changed before is found by the checks. `then`: pages of the file when it was opened as remembered. If all
/// pages that are not the same belong to the small tables, all others are as they were checked, and only these tables
/// are checked. Stores nothing if a check fails, or if a reader prevents the checkpoint of the write-ahead log. Not
/// inside a transaction.
void remember_file(Connection& db, const PageHashes& then, const FileChecks& checks);

}  // namespace grainsweep::store
