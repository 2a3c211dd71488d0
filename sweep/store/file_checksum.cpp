#include "sweep/store/file_checksum.hpp"

#include "sweep/store/soundness.hpp"

#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <numeric>
#include <set>
#include <span>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace grainsweep::store {

namespace {

constexpr std::array changed_by_writing = {std::pair(24, 28), std::pair(92, 100)};  // bytes of the first page

/// Returns the hash of every page, 0 for the page of the checksum; empty if the file is no whole number of pages.
PageHashes hashes_of_file(const Connection& db) {
    const auto page = static_cast<std::size_t>(db.value<std::int64_t>("PRAGMA page_size").value_or(0));
    const std::int64_t bytes = db.file_bytes();
    const auto size = static_cast<std::int64_t>(page);
    if (page == 0 || bytes % size != 0) return {};
    const auto own =
        db.value<std::int64_t>("SELECT rootpage FROM sqlite_schema WHERE name = 'file_checksum'").value_or(0);

    PageHashes hashes(static_cast<std::size_t>(bytes / size));
    constexpr std::size_t pages_at_once = 256;
    std::vector<std::byte> piece(page * pages_at_once);
    for (std::size_t first = 0; first < hashes.size(); first += pages_at_once) {
        const auto count = std::min(hashes.size() - first, pages_at_once);
        const auto read = std::span(piece).first(count * page);
        db.read_file(static_cast<std::int64_t>(first) * size, read);
        if (first == 0)
            for (const auto& [begin, end] : changed_by_writing)
                std::fill(read.begin() + begin, read.begin() + end, std::byte{0});
        for (std::size_t k = 0; k < count; ++k) {
            const auto name = static_cast<std::uint64_t>(first + k + 1);  // pages count from 1
            hashes[first + k] =
                name == static_cast<std::uint64_t>(own) ? 0 : XXH3_64bits_withSeed(read.data() + k * page, page, name);
        }
    }
    return hashes;
}

std::uint64_t sum_of_pages(const PageHashes& hashes) {
    return std::accumulate(hashes.begin(), hashes.end(), std::uint64_t{0});
}

/// Whether all pages that differ are of these tables and their indices.
bool differ_only_in(const Connection& db, std::span<const std::string_view> tables, const PageHashes& then,
                    const PageHashes& now) {
    std::set<std::int64_t> pages = {1};  // of the schema
    try {
        for (const auto table : tables) {
            auto names = db.prepare("SELECT name FROM sqlite_schema WHERE tbl_name = ?1 AND rootpage > 0");
            names.bind(1, table);
            while (names.step()) {
                auto rows = db.prepare("SELECT pageno FROM dbstat WHERE name = ?1");
                const auto name = names.get<std::string>(0);
                rows.bind(1, name);
                while (rows.step()) pages.insert(rows.get<std::int64_t>(0));
            }
        }
    } catch (const RefusedSql&) {  // an SQLite without this table
        return false;
    }
    if (now.size() < then.size()) return false;
    for (std::size_t k = 0; k < now.size(); ++k)
        if ((k >= then.size() || now[k] != then[k]) && !pages.contains(static_cast<std::int64_t>(k) + 1)) return false;
    return true;
}

bool log_waits(const std::filesystem::path& file) {
    auto log = file;
    std::error_code none;
    const auto bytes = std::filesystem::file_size(log += "-wal", none);
    return !none && bytes > 0;
}

}  // namespace

PageHashes pages_as_remembered(const Connection& db, const std::filesystem::path& file) {
    if (!has_table(db, "file_checksum") || log_waits(file)) return {};
    auto hashes = hashes_of_file(db);
    auto rows = db.ask("SELECT pages, checksum FROM file_checksum");
    const bool same = rows.next() && std::cmp_equal(rows.get<std::int64_t>(0), hashes.size()) &&
                      static_cast<std::uint64_t>(rows.get<std::int64_t>(1)) == sum_of_pages(hashes);
    return same ? hashes : PageHashes();
}

bool is_as_remembered(const Connection& db, const std::filesystem::path& file) {
    return !pages_as_remembered(db, file).empty();
}

void remember_file(Connection& db, const PageHashes& then, const FileChecks& checks) {
    // The row first: that it is there decides how many pages there are.
    db.run("INSERT INTO file_checksum VALUES (1, 0, 0) ON CONFLICT (only) DO UPDATE SET pages = 0");
    {
        auto rows = db.ask("PRAGMA wal_checkpoint(PASSIVE)");  // busy, frames, frames brought home; -1 without a log
        const bool done =
            rows.next() && rows.get<std::int64_t>(0) == 0 && rows.get<std::int64_t>(1) == rows.get<std::int64_t>(2);
        if (!done) return;
    }
    const auto now = hashes_of_file(db);
    if (now.empty()) return;
    db.execute("PRAGMA shrink_memory");  // forgets the pages that this connection holds in memory
    const bool little = !then.empty() && differ_only_in(db, checks.tables, then, now);
    if (!(little ? checks.tables_are_sound() : checks.all_is_sound())) return;
    db.run("UPDATE file_checksum SET pages = ?, checksum = ?", static_cast<std::int64_t>(now.size()),
           static_cast<std::int64_t>(sum_of_pages(now)));
}

}  // namespace grainsweep::store
