// The report's data of databases that grow, made anew by a thread of its own.
//
// Figures of a campaign (moments, indices, models) take longer than its results come: they are made again when
// something was committed; while a run computes, for a quarter of a second and a four-hundredth of the time.
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
    std::int64_t covered = 0;  ///< all results told until this number are in it
    std::string json;          ///< as page_data, fit to stand inside a script element
    std::string error;         ///< why there is none
};

class GrowingPage {
public:
    /// `told` counts the results that readers were told of one by one. Makes the first page before it returns; throws
    /// what that throws.
    GrowingPage(std::vector<std::filesystem::path> databases, const std::atomic<std::int64_t>& told);
    ~GrowingPage();

    /// Something was committed. `computing`: a run is under way beside.
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
    double last_seconds_ = 0, spent_ = 0;  ///< processor time of the last page, and of all since the run began
    std::chrono::steady_clock::time_point run_began_{};
    std::shared_ptr<const PageData> latest_;
    std::jthread thread_;  ///< ends first
};

}  // namespace grainsweep::live
