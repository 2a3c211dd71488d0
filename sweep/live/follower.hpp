// Follower of a database, which reads results as they are committed.
#pragma once

#include "sweep/campaign/json_writer.hpp"
#include "sweep/store/store.hpp"

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace grainsweep::live {

/// Follower of one database. A poll without changes costs three system calls. The file is open only while it changes,
/// so that hundreds of databases can be followed.
class Follower {
public:
    /// `ended` is asked often while the database is read, and stops reading.
    explicit Follower(std::filesystem::path database, std::function<bool()> ended = {});

    /// Returns the cases with a new outcome since the last poll, at most most_at_once; others follow with the next
    /// poll. Each is a JSON object {"case", "outcome", "attempts", "values": {observable: number}, "reason"}, with a
    /// reason only if an attempt stored one. Cases settled before this object was made are not included. Cases before
    /// the first open one, which only a run with --again changes, are checked in at most 1 % of the time.
    ///
    /// Errors of a database that is damaged, cut or replaced stay here: error() says them, and the file is tried again.
    [[nodiscard]] std::vector<campaign::JsonText> poll();
    /// Closes the file until it changes.
    void rest() { store_.reset(); }
    /// Returns whether a file is at the path.
    [[nodiscard]] bool in_place() const;
    /// Returns whether the file was made anew, or has other cases, since the last call.
    [[nodiscard]] bool take_anew() { return std::exchange(anew_, false); }
    [[nodiscard]] const std::string& error() const { return error_; }  ///< of the last poll; empty: none
    /// Returns whether a run, of any process, has the lock of the writer. False if the file cannot be read.
    [[nodiscard]] bool is_being_written();
    /// Returns whether the case has a result. False if the file cannot be read.
    [[nodiscard]] bool is_settled(std::string_view case_id);
    [[nodiscard]] const std::filesystem::path& file() const { return database_; }

    static constexpr std::size_t most_at_once = 5000;

private:
    struct Stamp {
        std::uintmax_t bytes = 0, log_bytes = 0;
        std::filesystem::file_time_type written{}, log_written{};
        std::array<std::uint64_t, 3> file{};  ///< file system, number and birth; zeros: there is none
        bool operator==(const Stamp&) const = default;
    };
    struct Settled {
        std::int64_t key = 0, attempts = 0;
        std::string id, outcome;
    };
    [[nodiscard]] Stamp stamp() const;
    using Clock = std::chrono::steady_clock;
    /// Returns the open database.
    [[nodiscard]] store::Store& store();
    /// Reads what is settled already.
    void begin();
    [[nodiscard]] std::vector<campaign::JsonText> read(const Stamp& now);
    /// Returns the settled cases from this key on that are not known yet, and marks them as known.
    [[nodiscard]] std::vector<Settled> fresh(std::int64_t first);
    [[nodiscard]] std::vector<campaign::JsonText> told(std::span<const Settled> settled);

    std::filesystem::path database_;
    std::function<bool()> ended_;
    std::optional<store::Store> store_;
    std::optional<Stamp> seen_, seen_whole_;
    Clock::time_point looked_whole_{}, used_{}, failed_{};
    double whole_seconds_ = 0;
    std::size_t rows_ = 0;  ///< cases at the last look at all
    bool anew_ = false;
    std::string error_;
    std::vector<std::uint32_t> known_;  ///< by case key: mark of the known result; 0: none
    std::int64_t first_open_ = 1;       ///< all cases before this key are settled
};

}  // namespace grainsweep::live
