// What the scheduler sees of its workers: places to put cases, and events.
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

/// A worker's process ended, wrote nonsense or fell silent. The case it was computing has failed, or was interrupted;
/// those that waited behind it were never begun.
struct Lost {
    std::optional<campaign::Attempt> running;
    std::vector<campaign::Attempt> queued;
    std::string reason;         ///< how it ended, and the last lines it wrote to standard error
    double seconds = 0;         ///< since it began `running`
    bool from_outside = false;  ///< no failure of the case: its worker was asked to end, or gave no sign of life
    /// The checkpoint of `running` is not to be used again: the case crashed on it, or after it on its own account.
    bool spoils_checkpoint = false;
};

/// The case exceeded its wall time; its worker was ended.
struct TimedOut {
    campaign::Attempt running;
    std::vector<campaign::Attempt> queued;
    std::string reason;
    double seconds = 0;
};

/// Given back unfinished.
struct GivenBack {
    campaign::Attempt attempt;
    std::string reason;
    double seconds = 0;   ///< since it was begun, 0 where it never was
    bool asked = true;    ///< the worker had been asked to stop
    bool broken = false;  ///< a file could not be written, a full disk say: no other case would fare better
};

struct Finished {
    campaign::CaseResult result;
    bool checkpointed = false;
};

struct Heartbeat {
    campaign::Attempt attempt;
    double progress = 0;
};

/// Something the user should know: which worker is waited for, which output was forgiven.
struct Remark {
    std::string text;
};

/// A request to stop: politely (first time) or at once (again).
struct Interrupted {
    bool at_once = false;
    bool goes_on = false;  ///< not the user: a system that will let it go on later
};

using PoolEvent = std::variant<Finished, Heartbeat, Lost, TimedOut, GivenBack, Remark, Interrupted>;

/// Where the next case goes.
struct Place {
    std::size_t worker = 0;
    std::shared_ptr<const campaign::Computer> computer;  ///< what it will be computed by
};

class Crew {
public:
    Crew() = default;
    Crew(const Crew&) = delete;
    Crew& operator=(const Crew&) = delete;
    virtual ~Crew() = default;

    /// So many cases wait: workers are started for them as far as there may be more. They take cases once ready.
    virtual void expect(std::size_t cases) = 0;
    /// So many cases wait still, after what could be handed out was. Cores that are left over then may go to cases that
    /// run, those with most left of their predicted seconds first; a crew that knows of none takes no notice.
    using SecondsLeft = std::function<double(const campaign::Attempt&)>;
    virtual void share_cores(std::size_t waiting, const SecondsLeft& left) {
        static_cast<void>(waiting), static_cast<void>(left);
    }
    /// Where a case can go now, if anywhere. Short cases queue up behind a running one. Good until wait().
    [[nodiscard]] virtual std::optional<Place> place_for(double predicted_seconds) = 0;
    virtual void give(const Place& place, const campaign::Attempt& attempt, const campaign::Case& question) = 0;
    /// The next event, or nothing: at the end of the time, or when a worker has become ready for its first case.
    [[nodiscard]] virtual std::optional<PoolEvent> wait(std::chrono::milliseconds at_most) = 0;
    /// Asks workers to finish or give back what they have and take nothing more.
    virtual void retire() = 0;
    /// Ends all workers now; what they were computing is lost.
    virtual void dismiss() = 0;
};

}  // namespace grainsweep::workers
