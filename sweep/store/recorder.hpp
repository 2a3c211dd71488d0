// The archive's pen: writes on a thread of its own in durable groups, so that dispatch never waits for the
// disk. What was written is known to be on disk only when take_durable() returns it.
#pragma once

#include "sweep/store/store.hpp"

#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <variant>
#include <vector>

namespace grainsweep::store {

class Recorder {
public:
    struct Stopped {
        std::string campaign;
        std::int64_t points = 0;
    };
    struct Checked {
        std::string campaign;
        ConvergenceRow row;
    };
    struct Begun {
        campaign::Attempt attempt;
        std::shared_ptr<const campaign::Computer> computer;
    };
    using Entry = std::variant<Begun, campaign::CaseResult, Checked, Stopped>;

    /// The store must outlive the recorder and is the recorder's alone until drain() returned.
    explicit Recorder(Store& store);
    ~Recorder();

    /// Hands over; returns at once, unless more waits for the disk than memory should hold. Throws what an earlier
    /// write failed with.
    void write(Entry entry);
    /// Results that reached the disk since the last call, in the order written.
    [[nodiscard]] std::vector<campaign::CaseResult> take_durable();
    /// Waits until everything handed over is on disk, and every place of the enrolled campaign; throws what a write
    /// failed with.
    void drain();

private:
    void run();
    void rethrow();
    /// Writes what waits, and some of what is left to enrol. False where that failed.
    bool write_waiting(std::unique_lock<std::mutex>& lock);
    void write_group(std::vector<Entry>& group, std::vector<campaign::CaseResult>& kept);

    Store& store_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<Entry> waiting_;
    std::size_t weight_ = 0;  ///< of what waits
    std::vector<campaign::CaseResult> durable_;
    std::exception_ptr failure_;
    bool busy_ = false, closing_ = false;
    bool enrols_;        ///< places of the campaign are left to be entered
    std::size_t piece_;  ///< of them, between two groups
    std::thread thread_;
};

}  // namespace grainsweep::store
