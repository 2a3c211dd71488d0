// Checksum of a whole database file. Checking every row and index of a million cases takes seconds; summing the hashes
// of the pages takes a fraction of a second. The last run checked or wrote the whole file, so an unchanged file is
// undamaged.
//
// Not included are the page of the checksum itself and the parts of the first page that SQLite changes with it: the
// change counter (bytes 24 to 27), and its version (92 to 99);
// https://www.sqlite.org/fileformat.html
#pragma once

#include "sweep/store/database.hpp"

#include <filesystem>
#include <functional>

namespace grainsweep::store {

/// Returns whether the file has the same bytes as after remember_file(). False if this is unknown: there is no
/// checksum, or a write-ahead log is pending. Call it inside a transaction, at least for reading.
[[nodiscard]] bool is_as_remembered(const Connection& db, const std::filesystem::path& file);

/// Sums the file, checks its contents, then stores the sum. A byte that changes after the summing changes the sum. A
/// byte that changed before is found by `is_sound`, which therefore must read from the disk. Stores nothing if the
/// check fails, or if a reader prevents the checkpoint of the write-ahead log. Not inside a transaction.
void remember_file(Connection& db, const std::function<bool()>& is_sound);

}  // namespace grainsweep::store
