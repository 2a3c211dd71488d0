// Estimate of a run's remaining time from the cases it has computed. Pure: uses no clock.
#pragma once

#include "sweep/campaign/case.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace grainsweep::schedule {

/// Estimator of the computing seconds that are left: predicted seconds times the ratio of measured to predicted seconds
/// so far. A running case that reports its share is assumed to continue at its speed so far. Cases can end before their
/// share is 1, when no particle moves any more; the shares at which they ended are used for the next ones. All times
/// are in seconds of the run.
class TimeLeft {
public:
    void begun(const campaign::Attempt& attempt, double predicted, double now);
    /// Stores the share, 0 to 1, that a case has done of its longest computation. The first share that a later attempt
    /// reports comes from a checkpoint.
    void reported(const campaign::Attempt& attempt, double share, double now);
    /// Stores that the case ended after `taken` seconds of computing.
    void ended(const campaign::Attempt& attempt, double taken, double now);
    /// Removes a case that was never begun, or that will start again.
    void taken_back(const campaign::CaseId& id) { running_.erase(id); }

    struct Seconds {
        double done = 0;   ///< all workers together, in this run
        double to_go = 0;  ///< all workers together
    };
    /// Returns the estimate. `waiting`: predicted seconds of all waiting cases. `last`: those of each waiting case, in
    /// their order; given near the end of the run, when some workers are idle while others still compute.
    [[nodiscard]] Seconds estimate(double waiting, std::size_t workers, double now,
                                   const std::optional<std::vector<double>>& last = {}) const;

private:
    struct Report {
        double share = 0, at = 0;
    };
    struct Running {
        std::int64_t number = 0;  ///< of the attempt
        double predicted = 0, given = 0;
        std::optional<Report> first, last;
    };
    /// Returns the share per second since the case was given to a worker, or, if there may have been a checkpoint,
    /// since its first report.
    using Cases = std::map<campaign::CaseId, Running>;
    [[nodiscard]] Cases::iterator find(const campaign::Attempt& attempt);
    [[nodiscard]] static double speed(const Running& one);
    [[nodiscard]] double last_share() const { return shared_ > 0 ? end_shares_ / shared_ : 1; }
    [[nodiscard]] double pace(double now) const;
    [[nodiscard]] double left_of(const Running& one, double pace, double now) const;

    Cases running_;
    double taken_ = 0, predicted_ = 0;    ///< of the cases that ended
    double end_shares_ = 0, shared_ = 0;  ///< weighted sum of the shares at which cases ended, and the sum of the
                                          ///< weights, which are their predictions
};

}  // namespace grainsweep::schedule
