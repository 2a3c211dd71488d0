// What the scheduler sees of its workers: places to put cases, and events.
#pragma once

#include "sweep/campaign/case.hpp"

#include <chrono>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace grainsweep::workers {

/// A worker's process ended, or spoke nonsense. The case it was computing has failed; those still in its
/// queue were never begun.
struct Lost {
    std::optional<campaign::Attempt> running;
    std::vector<campaign::Attempt> queued;
    std::string reason;  ///< how it ended, and the last lines it wrote to standard error
    double seconds = 0;  ///< since it began `running`
};

/// The case exceeded its wall time; its worker was stopped.
struct TimedOut {
    campaign::Attempt running;
    std::vector<campaign::Attempt> queued;
    std::string reason;
    double seconds = 0;
};

/// Given back unfinished after a stop.
struct GivenBack {
    campaign::Attempt attempt;
    double seconds = 0;  ///< since it was begun, 0 where it never was
};

struct Finished {
    campaign::CaseResult result;
    bool checkpointed = false;
};

struct Heartbeat {
    campaign::Attempt attempt;
    double progress = 0;
};

/// The user asked to stop: politely (first time) or at once (again).
struct Interrupted {
    bool at_once = false;
};

using PoolEvent = std::variant<Finished, Heartbeat, Lost, TimedOut, GivenBack, Interrupted>;

class Crew {
public:
    Crew() = default;
    Crew(const Crew&) = delete;
    Crew& operator=(const Crew&) = delete;
    virtual ~Crew() = default;

    /// Whether another case can be taken now. Short cases queue up behind a running one.
    [[nodiscard]] virtual bool has_room(double predicted_seconds) const = 0;
    virtual void start(const campaign::Attempt& attempt, const campaign::Case& question) = 0;
    /// The next event, or nothing within the time.
    [[nodiscard]] virtual std::optional<PoolEvent> wait(std::chrono::milliseconds at_most) = 0;
    /// Cases handed out and not yet accounted for by an event.
    [[nodiscard]] virtual std::size_t outstanding() const = 0;
    /// Tells workers to finish or park what they have and take nothing more.
    virtual void retire() = 0;
    /// Ends all workers now; what they were computing is lost.
    virtual void dismiss() = 0;
};

}  // namespace grainsweep::workers
