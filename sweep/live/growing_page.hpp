// Data of the report for growing databases, renewed by a thread, database by database.
//
// Figures of a campaign (moments, indices, models) take longer than the interval between results. They are computed
// again after commits; while a run computes, at low priority and only for a second plus a four-hundredth of the time. A
// database that cannot be read keeps its last figures, and is tried again.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace grainsweep::live {

struct PageData {
    std::int64_t version = 0;
    std::int64_t covered = 0;  ///< results up to this number are included
    std::string json;          ///< page_data, safe inside a script element
    std::string error;         ///< why a database has no data, or old ones
};

class GrowingPage {
public:
    /// Begins with a page without campaigns. `ended` is asked often and stops reading.
    GrowingPage(std::vector<std::filesystem::path> databases, std::function<bool()> ended);
    ~GrowingPage();

    /// Waits until every database was read once, at most this time. Returns whether this is so.
    bool await_first(std::chrono::milliseconds at_most);
    /// Requests a renewal of a database after a commit. `told`: number of results sent to readers one by one;
    /// `computing`: a run computes at the same time.
    void grown(const std::filesystem::path& database, std::int64_t told, bool computing);
    /// Replaces the list of databases. Those that stay keep their figures.
    void follow(const std::vector<std::filesystem::path>& databases, std::int64_t told);
    [[nodiscard]] std::shared_ptr<const PageData> latest() const;
    /// Returns whether the thread computes figures.
    [[nodiscard]] bool busy() const { return busy_; }

private:
    /// Database and its figures.
    struct Part {
        std::filesystem::path file;
        std::shared_ptr<const std::string> campaigns = {};  ///< members of the list, separated by commas
        std::string error = {};
        std::int64_t covered = 0;
        bool stale = true, read = false;
        std::chrono::steady_clock::time_point tried{};
    };
    void keep_up(const std::stop_token& stop);
    /// Renews stale parts for at most this time. Returns whether one is left.
    bool renew(const std::stop_token& stop, std::chrono::milliseconds at_most);
    void publish();

    std::function<bool()> ended_;
    mutable std::mutex mutex_;
    std::condition_variable_any wake_;
    std::vector<Part> parts_;
    bool grown_ = true, computing_ = false;
    std::int64_t told_ = 0;
    double last_seconds_ = 0, spent_ = 0;  ///< processor time of the last page, and of all pages since the run began
    std::chrono::steady_clock::time_point run_began_{};
    std::shared_ptr<const PageData> latest_;
    std::atomic<bool> busy_ = false;
    std::jthread thread_;  ///< last member: it ends first
};

}  // namespace grainsweep::live
