// Workers as the scheduler sees them: places for cases, and events.
#pragma once

#include "sweep/campaign/case.hpp"

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace grainsweep::workers {

/// Event: a worker ended, sent an invalid message or became silent. Its running case failed or was interrupted. The
/// cases queued behind it were never begun.
struct Lost {
    std::optional<campaign::Attempt> running;
    std::vector<campaign::Attempt> queued;
    std::string reason;         ///< how it ended, and the last lines it wrote to standard error
    double seconds = 0;         ///< since the worker began `running`
    bool from_outside = false;  ///< the case did not fail: its worker received a request to end, or was silent
    /// Whether the checkpoint of `running` must not be used again, because the case crashed after it.
    bool spoils_checkpoint = false;
};

/// Event: the case exceeded its limit of wall time and its worker was ended.
struct TimedOut {
    campaign::Attempt running;
    std::vector<campaign::Attempt> queued;
    std::string reason;
    double seconds = 0;
};

/// Event: a worker returned a case unfinished.
struct GivenBack {
    campaign::Attempt attempt;
    std::string reason;
    double seconds = 0;   ///< since the case began; 0: it was never begun
    bool asked = true;    ///< the worker had received a request to stop
    bool broken = false;  ///< a file could not be written (a full disk): every other case would meet the same error
};

struct Finished {
    campaign::CaseResult result;
    bool checkpointed = false;
};

struct Heartbeat {
    campaign::Attempt attempt;
    double progress = 0;
};

/// Event: a message for the user, such as the worker that the run waits for, or output that was ignored.
struct Remark {
    std::string text;
};

/// Event: a request to stop. The first one lets cases be saved, the second one stops at once.
struct Interrupted {
    bool at_once = false;
    bool goes_on = false;  ///< from a batch system, which will continue the run later, not from the user
};

using PoolEvent = std::variant<Finished, Heartbeat, Lost, TimedOut, GivenBack, Remark, Interrupted>;

/// Place for the next case.
struct Place {
    std::size_t worker = 0;
    std::shared_ptr<const campaign::Computer> computer;  ///< program and machine that will compute it
};

class WorkerPool {
public:
    WorkerPool() = default;
    WorkerPool(const WorkerPool&) = delete;
    WorkerPool& operator=(const WorkerPool&) = delete;
    virtual ~WorkerPool() = default;

    /// Starts workers for the waiting cases, up to the largest number of workers. A worker takes cases once it is
    /// ready.
    virtual void expect(std::size_t cases) = 0;
    /// Gives idle cores to running cases, those with most predicted seconds left first. Called with the number of cases
    /// that still wait after all places are filled. A crew without idle cores ignores it.
    using SecondsLeft = std::function<double(const campaign::Attempt&)>;
    virtual void share_cores(std::size_t waiting, const SecondsLeft& left) {
        static_cast<void>(waiting), static_cast<void>(left);
    }
    /// Returns a place for a case, if there is one now. Short cases queue behind a running one. The place is valid
    /// until wait().
    [[nodiscard]] virtual std::optional<Place> place_for(double predicted_seconds) = 0;
    virtual void give(const Place& place, const campaign::Attempt& attempt, const campaign::Case& question) = 0;
    /// Returns the next event. Empty: the time ended, or a worker became ready for its first case.
    [[nodiscard]] virtual std::optional<PoolEvent> wait(std::chrono::milliseconds at_most) = 0;
    /// Requests that workers finish or give back their cases. They receive no further case.
    virtual void retire() = 0;
    /// Ends all workers at once. Their running cases are lost.
    virtual void dismiss() = 0;
};

}  // namespace grainsweep::workers
