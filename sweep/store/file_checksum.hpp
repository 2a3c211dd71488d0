// The checksum of a whole database file. Checking every row and index of a million cases takes seconds, adding up the
// hashes of the pages a fraction of one. The last run had found or written all of the file sound, so an unchanged file
// is sound.
//
// Not counted are the page of the checksum itself, and the parts of the first page that SQLite changes with it: the
// change counter (bytes 24 to 27) and its version (92 to 99);
// https://www.sqlite.org/fileformat.html
#pragma once

#include "sweep/store/database.hpp"

#include <filesystem>
#include <functional>

namespace grainsweep::store {

/// Whether the file is, byte by byte, as remember_file() left it. False where that is not known: there is no checksum,
/// or a write-ahead log is waiting. Inside a transaction, of reading at least.
[[nodiscard]] bool is_as_remembered(const Connection& db, const std::filesystem::path& file);

/// Adds up the file, checks its contents, then stores the sum. A byte that changes after it was added up changes the
/// sum. A byte that changed before is found by `is_sound`, which therefore reads from the disk and not from memory.
/// Stores nothing where the check fails, or where a reader keeps the write-ahead log from being
/// brought home. Not inside a transaction.
void remember_file(Connection& db, const std::function<bool()>& is_sound);

}  // namespace grainsweep::store
