// Task of a campaign without a main program: claims cases, lets a crew compute them, and writes the answers to the
// spool. It begins with its own share, the longest cases first. Then it takes cases that other tasks have not begun or
// have left unfinished.
#pragma once

#include "sweep/campaign/cases.hpp"
#include "sweep/schedule/scheduler.hpp"
#include "sweep/spool/spool.hpp"
#include "sweep/workers/worker_pool.hpp"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace grainsweep::spool {

/// Share: part `part` of `of`, from 1.
struct Share {
    std::int64_t part = 1, of = 1;
};

struct TaskRules {
    Share share;
    std::int64_t attempts = 3;  ///< tries of a case that crashes or times out, by all tasks
    double lease = 300;         ///< s; claims of a task that is silent for this time are free
    schedule::Walltime walltime = {};
};

/// Returns the order in which a task of this share takes the cases, as indices of `predicted` (seconds).
[[nodiscard]] std::vector<std::uint32_t> order_of(const std::vector<double>& predicted, const Share& share);

class Task {
public:
    struct Tally {
        std::size_t cases = 0;         ///< distinct cases
        std::size_t answered = 0;      ///< by any task, as known to this one
        std::size_t failed = 0;        ///< of those: given up, unstable or rejected
        std::size_t computed = 0;      ///< by this task
        std::size_t elsewhere = 0;     ///< at the end: claimed by other living tasks
        std::size_t left_out = 0;      ///< cases that do not fit into the time left
        double shortest_left_out = 0;  ///< shortest prediction of these cases, s
    };
    struct Watchers {
        std::function<void(const Tally&)> progress = [](const Tally&) {};
        std::function<void(const std::string&)> note = [](const std::string&) {};
        std::function<void(const campaign::CaseId&)> forget_checkpoint = [](const campaign::CaseId&) {};
    };

    /// `predicted`: seconds of the case at each place.
    Task(const Spool& spool, campaign::Cases cases, const std::vector<double>& predicted, workers::WorkerPool& crew,
         TaskRules rules, Watchers watchers);

    /// Runs until no case is left for this task. Returns `limited` if other tasks compute the rest. Throws only
    /// SystemError.
    schedule::Ending run();
    [[nodiscard]] const Tally& tally() const { return tally_; }

private:
    struct Progress {
        std::int64_t next = 1;  ///< number of the next attempt, as far as known
        std::int64_t failures = 0;
        std::int64_t given_back = 0;  ///< by this task
    };
    struct Running {
        std::uint32_t place = 0;
        campaign::Computer computer;
    };
    enum class Taken { claimed, over, elsewhere };

    void hand_out();
    void look_at_time();
    void look_elsewhere();
    [[nodiscard]] bool claims(std::uint32_t place);
    [[nodiscard]] Taken take(std::uint32_t place);
    [[nodiscard]] bool pass_over(std::uint32_t place, const campaign::Attempt& attempt, const Entry& entry);
    [[nodiscard]] bool is_alive(const campaign::Attempt& attempt, const Claim& claim);
    void handle(workers::PoolEvent event);
    void finish(const campaign::CaseResult& result);
    void fail(const campaign::Attempt& attempt, campaign::Outcome outcome, const std::string& reason, double seconds);
    void give_back(const campaign::Attempt& attempt, const std::string& reason, double seconds, bool asked);
    void never_begun(const std::vector<campaign::Attempt>& attempts);
    void settle(campaign::Outcome outcome);
    [[nodiscard]] schedule::Ending ending() const;

    const Spool& spool_;
    campaign::Cases cases_;
    std::vector<double> predicted_;
    workers::WorkerPool& crew_;
    TaskRules rules_;
    Watchers watchers_;
    TaskFile file_;
    std::deque<std::uint32_t> open_;        ///< in the order in which this task takes them
    std::vector<std::uint32_t> elsewhere_;  ///< claimed by others
    std::map<std::uint32_t, Progress> known_;
    std::map<campaign::CaseId, Running> running_;
    Tally tally_;
    double looked_elsewhere_ = 0;
    bool waits_ = true;  ///< the task waits for others that may be dead
    bool at_once_ = false, closed_ = false;
    std::optional<schedule::Ending> early_;
    std::optional<std::string> broken_;
};

}  // namespace grainsweep::spool
