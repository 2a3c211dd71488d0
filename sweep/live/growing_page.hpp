// Data of the report for growing databases, renewed by a thread.
//
// Figures of a campaign (moments, indices, models) take longer than the interval between results. They are computed
// again after commits; while a run computes, only for a quarter of a second plus a four-hundredth of the time.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
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
    std::string error;         ///< why there is no data
};

class GrowingPage {
public:
    /// Makes the first page; throws its errors. `told`: number of results sent to readers one by one.
    GrowingPage(std::vector<std::filesystem::path> databases, const std::atomic<std::int64_t>& told);
    ~GrowingPage();

    /// Requests a renewal after a commit. `computing`: a run computes at the same time.
    void grown(bool computing);
    [[nodiscard]] std::shared_ptr<const PageData> latest() const;

private:
    [[nodiscard]] std::shared_ptr<const PageData> make(std::int64_t version) const;
    void keep_up(const std::stop_token& stop);

    std::vector<std::filesystem::path> databases_;
    const std::atomic<std::int64_t>& told_;
    mutable std::mutex mutex_;
    std::condition_variable_any wake_;
    bool grown_ = false, computing_ = false;
    double last_seconds_ = 0, spent_ = 0;  ///< processor time of the last page, and of all pages since the run began
    std::chrono::steady_clock::time_point run_began_{};
    std::shared_ptr<const PageData> latest_;
    std::jthread thread_;  ///< last member: it ends first
};

}  // namespace grainsweep::live
