// Follower of a database, which reads results as they are committed.
#pragma once

#include "sweep/campaign/json_writer.hpp"
#include "sweep/store/store.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace grainsweep::live {

/// Follower of one database. A poll without changes costs two system calls.
class Follower {
public:
    /// Throws BrokenWorld, or WrongQuestion if the file is no database of this program.
    explicit Follower(std::filesystem::path database);

    /// Returns the cases with a new outcome since the last poll, at most most_at_once; others follow with the next
    /// poll. Each is a JSON object {"case", "outcome", "attempts", "values": {observable: number}, "reason"}, with a
    /// reason only if an attempt stored one. Cases settled before this object was made are not included. Cases before
    /// the first open one, which only a run with --again changes, are checked in at most 1 % of the time.
    [[nodiscard]] std::vector<campaign::JsonText> poll();
    /// Returns whether the opened file is still at its path.
    [[nodiscard]] bool in_place() const;
    [[nodiscard]] const std::filesystem::path& file() const { return database_; }

    static constexpr std::size_t most_at_once = 5000;

private:
    struct Stamp {
        std::uintmax_t bytes = 0, log_bytes = 0;
        std::filesystem::file_time_type written{}, log_written{};
        bool operator==(const Stamp&) const = default;
    };
    struct Settled {
        std::int64_t key = 0, attempts = 0;
        std::string id, outcome;
    };
    [[nodiscard]] Stamp stamp() const;
    using Clock = std::chrono::steady_clock;
    /// Returns the settled cases from this key on that are not known yet, and marks them as known.
    [[nodiscard]] std::vector<Settled> fresh(std::int64_t first);
    [[nodiscard]] std::vector<campaign::JsonText> told(std::span<const Settled> settled) const;

    std::filesystem::path database_;
    store::Store store_;
    std::optional<Stamp> seen_, seen_whole_;
    Clock::time_point looked_whole_{};
    double whole_seconds_ = 0;
    std::vector<std::uint32_t> known_;  ///< by case key: mark of the known result; 0: none
    std::int64_t first_open_ = 1;       ///< all cases before this key are settled
};

}  // namespace grainsweep::live
