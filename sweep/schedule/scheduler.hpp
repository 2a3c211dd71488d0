// The one loop: hand out what the plan says, record what the crew answers, ask the judge whether it is
// enough. Decisions are the plan's and the judge's, processes the crew's, the disk the recorder's.
#pragma once

#include "sweep/schedule/judge.hpp"
#include "sweep/schedule/plan.hpp"
#include "sweep/schedule/time_left.hpp"
#include "sweep/store/recorder.hpp"
#include "sweep/workers/crew.hpp"

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace grainsweep::schedule {

/// Why a run ended.
enum class Ending {
    finished,   ///< every case is settled or given up
    converged,  ///< the statistics were good enough
    limited,    ///< as many cases as asked for in this run
    too_many_failures,
    interrupted,
    out_of_time,   ///< what is left does not fit into the time there is
    asked_to_end,  ///< by a system that will let it go on later
    too_long,      ///< what is left is predicted to fit into no run
};

/// How long a run may take. Seconds.
struct Walltime {
    std::function<double()> left = {};  ///< until every worker must have been asked to stop; empty: no limit
    double whole = 0;                   ///< what `left` begins with in a run of full length
    bool cases_go_on = true;            ///< an unfinished case goes on in another run from where it was
    double shortest_part = 0;           ///< such a case is not begun for less
};

/// A case that a worker has, begun or queued behind another.
struct UnderWay {
    std::int64_t attempt = 0;
    std::shared_ptr<const campaign::Computer> computer;
    std::optional<double> share;  ///< done, 0 to 1, as last reported; none: not begun, or not known
    double given = 0;             ///< when it was handed out, in seconds of the run
};

/// What watchers get. Counts are of results on disk.
struct Progress {
    Plan::Tally tally;
    std::size_t durable = 0;  ///< results of this run on disk
    std::map<campaign::CaseId, UnderWay> under_way;
    double seconds = 0;   ///< since the run began
    double computed = 0;  ///< seconds, all workers together
    /// The same, of what it will still compute: all that is left, or less where the number of cases is limited or the
    /// statistics are expected to converge before.
    double to_compute = 0;
    bool at_most = false;   ///< it may end sooner: the statistics do not say yet when they will have converged
    std::string judgement;  ///< last verdict on convergence in one line
};

struct Watchers {
    std::function<void(const Progress&)> progress = [](const Progress&) {};
    std::function<void(const std::string&)> note = [](const std::string&) {};  ///< a failure, in one line
    std::function<void(const campaign::CaseId&)> forget_checkpoint = [](const campaign::CaseId&) {};
};

class Scheduler {
public:
    Scheduler(std::string campaign, Plan& plan, workers::Crew& crew, store::Recorder& recorder, Judge* judge,
              Watchers watchers, Walltime walltime = {});

    /// Runs until nothing is left to do, the judge is satisfied or the user interrupts. Returns with
    /// everything on disk. Throws only for a broken world.
    Ending run();

private:
    using Clock = std::chrono::steady_clock;

    void hand_out();
    /// Leaves out what does not fit into the time left, and stops when there is none.
    void look_at_time();
    [[nodiscard]] Ending ending() const;
    /// Of what is left, the part that is computed before the statistics are expected to converge; none: not known yet.
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
    workers::Crew& crew_;
    store::Recorder& recorder_;
    Judge* judge_;
    Watchers watchers_;
    Walltime walltime_;
    Clock::time_point began_ = Clock::now();
    TimeLeft time_left_;
    double estimated_ = -1;  ///< when, in seconds of the run
    Progress progress_;
    std::optional<Ending> early_;
    std::optional<std::string> broken_;  ///< why nothing more can be computed
    bool at_once_ = false;
    std::vector<campaign::CaseId> checkpointed_;
};

}  // namespace grainsweep::schedule
