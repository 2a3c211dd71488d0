// How long the rest of a run will take, learned from what it has computed so far. Pure: sees no clock.
#pragma once

#include "sweep/campaign/case.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

namespace grainsweep::schedule {

/// Estimates the seconds of computing that are left: predictions times a pace, the ratio of the seconds that cases took
/// to those predicted. A running case that reports its share goes on as fast as it came so far. Cases that end before
/// their share is 1, because nothing moves any more, teach where the next ones will end. All times in seconds of the
/// run.
class TimeLeft {
public:
    void begun(const campaign::Attempt& attempt, double predicted, double now);
    /// The case has done a share of 0 to 1 of what it may compute. What a later attempt reports first was in a
    /// checkpoint.
    void reported(const campaign::Attempt& attempt, double share, double now);
    /// The case ended after so many seconds of computing.
    void ended(const campaign::Attempt& attempt, double taken, double now);
    /// The case was handed out for nothing, or will begin again.
    void taken_back(const campaign::CaseId& id) { running_.erase(id); }

    struct Seconds {
        double done = 0;   ///< all workers together, in this run
        double to_go = 0;  ///< all workers together
    };
    /// `waiting`: predicted seconds of all cases that are not handed out yet. `last`: of each of them, in their order,
    /// near the end of the run, where some workers have nothing left to do while others still compute.
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
    /// Share per second since the case was given, or since its first report where there may have been a checkpoint.
    using Cases = std::map<campaign::CaseId, Running>;
    [[nodiscard]] Cases::iterator find(const campaign::Attempt& attempt);
    [[nodiscard]] static double speed(const Running& one);
    [[nodiscard]] double last_share() const { return shared_ > 0 ? end_shares_ / shared_ : 1; }
    [[nodiscard]] double pace(double now) const;
    [[nodiscard]] double left_of(const Running& one, double pace, double now) const;

    Cases running_;
    double taken_ = 0, predicted_ = 0;    ///< of the cases that ended
    double end_shares_ = 0, shared_ = 0;  ///< shares at which cases ended, weighed by their predictions; the weights
};

}  // namespace grainsweep::schedule
