// Recorder of results: writes to the database on a thread of its own in durable groups, so that the scheduler never
// waits for the disk. A result is on disk when take_durable() returns it.
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

    /// The store must outlive the recorder; only the recorder may use it until drain() returns.
    explicit Recorder(Store& store);
    ~Recorder();

    /// Queues an entry and returns at once, unless the queue is too long for memory. Throws the error of an earlier
    /// write.
    void write(Entry entry);
    /// Returns the results that reached the disk since the last call, in the order of writing.
    [[nodiscard]] std::vector<campaign::CaseResult> take_durable();
    /// Waits until all queued entries and all places of the enrolled campaign are on disk. Throws the error of a write.
    void drain();

private:
    void run();
    void rethrow();
    /// Writes the queue, and some of the places left to enrol. Returns false if this failed.
    bool write_waiting(std::unique_lock<std::mutex>& lock);
    void write_group(std::vector<Entry>& group, std::vector<campaign::CaseResult>& kept);

    Store& store_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<Entry> waiting_;
    std::size_t weight_ = 0;  ///< weight of the queue
    std::vector<campaign::CaseResult> durable_;
    std::exception_ptr failure_;
    bool busy_ = false, closing_ = false;
    bool enrols_;        ///< places of the campaign are not entered yet
    std::size_t piece_;  ///< places entered between two groups
    std::thread thread_;
};

}  // namespace grainsweep::store
