// The loop of a run: takes cases from the plan, gives them to the crew, stores the answers with the recorder, and stops
// when the judge reports convergence.
#pragma once

#include "sweep/schedule/judge.hpp"
#include "sweep/schedule/plan.hpp"
#include "sweep/schedule/time_left.hpp"
#include "sweep/store/recorder.hpp"
#include "sweep/workers/worker_pool.hpp"

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace grainsweep::schedule {

/// Reason why a run ended.
enum class Ending {
    finished,   ///< every case is settled or given up
    converged,  ///< the statistics reached their tolerance
    limited,    ///< the run reached its limit of cases
    too_many_failures,
    failed_alike,  ///< the first cases all failed for one reason
    interrupted,
    out_of_time,   ///< the remaining cases do not fit into the time left
    asked_to_end,  ///< by a batch system that will continue the run later
    too_long,      ///< the remaining cases are predicted to take longer than any run
};

/// Limit of a run's time, in seconds.
struct Walltime {
    std::function<double()> left = {};  ///< time until every worker must have received the request to stop; empty: no
                                        ///< limit
    double whole = 0;                   ///< value of `left` at the start of a run of full length
    bool cases_go_on = true;            ///< an unfinished case continues in another run from its checkpoint
    double shortest_part = 0;           ///< a case that can continue is started only if at least this much time is left
};

/// Case given to a worker, begun or queued behind another.
struct UnderWay {
    std::int64_t attempt = 0;
    std::shared_ptr<const campaign::Computer> computer;
    std::optional<double> share;  ///< share done, 0 to 1, as last reported; empty: not begun, or unknown
    double given = 0;             ///< when it was handed out, in seconds of the run
};

/// Progress of a run for displays. Counts are of results on disk.
struct Progress {
    Plan::Tally tally;
    std::size_t durable = 0;  ///< results of this run on disk
    std::map<campaign::CaseId, UnderWay> under_way;
    double seconds = 0;   ///< since the run began
    double computed = 0;  ///< seconds, all workers together
    /// Seconds still to compute, all workers together: all remaining cases, or fewer if the number of cases is limited
    /// or convergence is expected earlier.
    double to_compute = 0;
    bool at_most = false;   ///< the run may end sooner: the point of convergence cannot be estimated yet
    std::string judgement;  ///< last verdict on convergence in one line
};

struct Watchers {
    std::function<void(const Progress&)> progress = [](const Progress&) {};
    std::function<void(const std::string&)> note = [](const std::string&) {};  ///< a failure, in one line
    std::function<void(const campaign::CaseId&)> forget_checkpoint = [](const campaign::CaseId&) {};
};

class Scheduler {
public:
    Scheduler(std::string campaign, Plan& plan, workers::WorkerPool& crew, store::Recorder& recorder, Judge* judge,
              Watchers watchers, Walltime walltime = {});

    /// Runs until no case is left, the statistics converge or the user interrupts. All results are on disk when it
    /// returns. Throws only SystemError.
    Ending run();

private:
    using Clock = std::chrono::steady_clock;

    void hand_out();
    /// Leaves out cases that do not fit into the time left, and stops the run when no time is left.
    void look_at_time();
    [[nodiscard]] Ending ending() const;
    /// Returns the share of the remaining cases that is computed before convergence is expected; empty: unknown.
    [[nodiscard]] std::optional<double> share_to_go() const;
    [[nodiscard]] double seconds() const { return std::chrono::duration<double>(Clock::now() - began_).count(); }
    void handle(workers::PoolEvent event);
    void handle_finished(workers::Finished& finished);
    void handle_failure(campaign::CaseResult result);
    void take_back(const std::vector<campaign::Attempt>& attempts);
    void handle_given_back(const campaign::Attempt& attempt, std::string reason, double seconds, bool noted);
    void judge_prefix(Judge::Models models = Judge::Models::beside);
    void show();

    std::string campaign_;
    Plan& plan_;
    workers::WorkerPool& crew_;
    store::Recorder& recorder_;
    Judge* judge_;
    Watchers watchers_;
    Walltime walltime_;
    Clock::time_point began_ = Clock::now();
    TimeLeft time_left_;
    double estimated_ = -1;  ///< time of the last estimate, in seconds of the run
    Progress progress_;
    std::optional<Ending> early_;
    std::optional<std::string> broken_;  ///< reason why no further case can be computed
    bool at_once_ = false;
    std::vector<campaign::CaseId> checkpointed_;
};

}  // namespace grainsweep::schedule
