#include "sweep/store/file_checksum.hpp"

#include "sweep/store/soundness.hpp"

#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

namespace grainsweep::store {

namespace {

constexpr std::array changed_by_writing = {std::pair(24, 28), std::pair(92, 100)};  // bytes of the first page

struct FileSum {
    std::int64_t pages = 0;
    std::uint64_t sum = 0;
    bool operator==(const FileSum&) const = default;
};

/// Returns the sum; empty if the file is no whole number of pages.
std::optional<FileSum> sum_of_file(const Connection& db) {
    const auto page = static_cast<std::size_t>(db.value<std::int64_t>("PRAGMA page_size").value_or(0));
    const std::int64_t bytes = db.file_bytes();
    const auto size = static_cast<std::int64_t>(page);
    if (page == 0 || bytes % size != 0) return std::nullopt;
    const auto own =
        db.value<std::int64_t>("SELECT rootpage FROM sqlite_schema WHERE name = 'file_checksum'").value_or(0);

    FileSum sum{bytes / size, 0};
    constexpr std::size_t pages_at_once = 256;
    std::vector<std::byte> piece(page * pages_at_once);
    for (std::int64_t first = 0; first < sum.pages; first += static_cast<std::int64_t>(pages_at_once)) {
        const auto count = static_cast<std::size_t>(
            std::min<std::int64_t>(sum.pages - first, static_cast<std::int64_t>(pages_at_once)));
        const auto read = std::span(piece).first(count * page);
        db.read_file(first * size, read);
        if (first == 0)
            for (const auto& [begin, end] : changed_by_writing)
                std::fill(read.begin() + begin, read.begin() + end, std::byte{0});
        for (std::size_t k = 0; k < count; ++k) {
            const auto name = static_cast<std::uint64_t>(first) + k + 1;  // pages count from 1
            if (name == static_cast<std::uint64_t>(own)) continue;
            sum.sum += XXH3_64bits_withSeed(read.data() + k * page, page, name);
        }
    }
    return sum;
}

bool log_waits(const std::filesystem::path& file) {
    auto log = file;
    std::error_code none;
    const auto bytes = std::filesystem::file_size(log += "-wal", none);
    return !none && bytes > 0;
}

}  // namespace

bool is_as_remembered(const Connection& db, const std::filesystem::path& file) {
    std::optional<FileSum> stored;
    if (!has_table(db, "file_checksum")) return false;
    {
        auto rows = db.ask("SELECT pages, checksum FROM file_checksum");
        if (rows.next()) stored = {rows.get<std::int64_t>(0), static_cast<std::uint64_t>(rows.get<std::int64_t>(1))};
    }
    return stored && !log_waits(file) && sum_of_file(db) == stored;
}

void remember_file(Connection& db, const std::function<bool()>& is_sound) {
    // The row first: that it is there decides how many pages there are.
    db.run("INSERT INTO file_checksum VALUES (1, 0, 0) ON CONFLICT (only) DO UPDATE SET pages = 0");
    {
        auto rows = db.ask("PRAGMA wal_checkpoint(PASSIVE)");  // busy, frames, frames brought home; -1 without a log
        const bool done =
            rows.next() && rows.get<std::int64_t>(0) == 0 && rows.get<std::int64_t>(1) == rows.get<std::int64_t>(2);
        if (!done) return;
    }
    const auto sum = sum_of_file(db);
    if (!sum) return;
    db.execute("PRAGMA shrink_memory");  // forgets the pages that this connection holds in memory
    if (!is_sound()) return;
    db.run("UPDATE file_checksum SET pages = ?, checksum = ?", sum->pages, static_cast<std::int64_t>(sum->sum));
}

}  // namespace grainsweep::store
