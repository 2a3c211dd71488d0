// Decides which case runs next, whether a failed case is tried again, and when a run stops. Pure: uses no process,
// clock or database.
//
// A question is a distinct case: a case that stands at several places of the design is computed once. Cases run in the
// order of the design, so that the finished part is always a usable prefix. Long cases run first only near the end,
// when the remaining work is less than a few times the longest case on every worker.
#pragma once

#include "sweep/campaign/case.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

namespace grainsweep::schedule {

/// Stored state of a question at the start of the run.
struct History {
    std::int32_t attempts = 0;  ///< highest attempt number
    std::int32_t failures = 0;  ///< of those, crashed or timed out
    std::optional<campaign::Outcome> outcome = {};
    bool asked = true;  ///< wanted by this run; false: belongs to a larger stored design, counts in the prefix, is
                        ///< never computed
};

struct Rules {
    std::int64_t attempts = 3;     ///< tries of a case that crashes or times out
    std::int64_t give_backs = 10;  ///< times in this run that a case may be given back without progress
    std::optional<std::int64_t> stop_after_failures = {};  ///< start no case after so many failed cases
    std::optional<std::int64_t> max_cases = {};            ///< settle at most so many in this run
    std::optional<campaign::Outcome> again = {};           ///< rerun cases with this outcome
    std::size_t workers = 1;                               ///< cases computed at the same time
    /// Start no case after the first so many all failed for one reason, if no case has an answer. Cases of such a run
    /// are tried again by the next one.
    std::optional<std::size_t> stop_after_alike = {};
};

/// Number of cases that must fail for one reason before a run stops.
inline constexpr std::size_t enough_alike = 8;

/// Distinct cases of a plan: a repeated case stands here once.
struct Questions {
    std::function<campaign::Case(std::uint32_t question)> ask;
    std::vector<History> histories;
    std::vector<double> predicted;  ///< seconds
    /// Index of the question of each placed case. Empty: place i has question i.
    std::vector<std::uint32_t> places;
    /// Block of each question, in ascending order. The campaign may stop after each block, so no case of a later block
    /// is brought forward. Empty: convergence does not stop the campaign.
    std::vector<std::uint32_t> blocks;
};

class Plan {
public:
    Plan(Questions questions, const Rules& rules);

    struct Start {
        campaign::Attempt attempt;
        campaign::Case question;
        double predicted_seconds = 0;
    };
    /// Returns the next attempt to start, if there is one now.
    [[nodiscard]] std::optional<Start> next();
    /// Returns the predicted seconds of the attempt that next() would return, if any.
    [[nodiscard]] std::optional<double> next_predicted() const;
    /// Returns how many attempts next() could return now, one after the other.
    [[nodiscard]] std::size_t waiting() const;

    /// Returns the predicted seconds of the waiting attempts, in their order, if they are at most `most`.
    [[nodiscard]] std::optional<std::vector<double>> last_predicted(std::size_t most) const;

    /// Returns the predicted seconds of a running attempt; 0: it is not running.
    [[nodiscard]] double predicted(const campaign::Attempt& attempt) const;
    [[nodiscard]] std::size_t workers() const { return rules_.workers; }
    /// Returns the predicted seconds that a running attempt still needs; 0: it is not running.
    [[nodiscard]] double seconds_left(const campaign::Attempt& attempt) const;
    /// Stores the share that a running attempt has done, 0 to 1.
    void advanced(const campaign::Attempt& attempt, double share);

    enum class Verdict { settled, again, gave_up, stale };
    /// Stores the outcome of an attempt that ended, and the reason of a failure.
    Verdict ended(const campaign::Attempt& attempt, campaign::Outcome outcome, std::string_view reason = {});
    /// Returns an unfinished case to the head of the queue; its attempt does not count. A case given back too often
    /// without progress is given up in this run.
    Verdict given_back(const campaign::Attempt& attempt);
    /// Returns a case that no worker began to the head of the queue, and frees the number of the attempt.
    void never_begun(const campaign::Attempt& attempt);
    /// Starts no case in this run that is predicted to take longer.
    void leave_out_longer_than(double seconds);
    [[nodiscard]] std::size_t left_out() const { return left_out_; }
    /// Returns the shortest prediction among the cases left out by leave_out_longer_than(), seconds.
    [[nodiscard]] double shortest_left_out() const { return shortest_left_out_; }
    /// Starts no further case.
    void close() { closed_ = true; }

    [[nodiscard]] bool too_many_failures() const {
        return rules_.stop_after_failures && std::cmp_greater_equal(tally_.failed_now, *rules_.stop_after_failures);
    }
    /// Returns whether the first cases of this run all failed for one reason; Tally::failed_alike is the reason.
    [[nodiscard]] bool failed_alike() const {
        return rules_.stop_after_alike && alike_ >= *rules_.stop_after_alike && may_be_alike_;
    }
    /// Returns how many cases that failed in an earlier run are tried again, because none of that run had an answer.
    [[nodiscard]] std::size_t tried_again() const { return tried_again_; }
    /// Returns whether no case is running and none can be started.
    [[nodiscard]] bool over() const { return under_way_.empty() && !next_predicted(); }
    /// Returns the length of the longest prefix of the placed cases in which every question is decided.
    [[nodiscard]] std::size_t settled_prefix();

    struct Tally {
        std::size_t questions = 0;
        std::size_t decided = 0;       ///< settled or given up, before or in this run
        std::size_t settled_now = 0;   ///< completed or skipped in this run
        std::size_t failed_now = 0;    ///< given up, unstable or rejected in this run
        std::size_t failed = 0;        ///< given up or settled as unstable or rejected, in all runs
        double predicted_waiting = 0;  ///< seconds, of what this run may still start
        std::string failed_alike;      ///< reason of the first failure, in one line
    };
    [[nodiscard]] const Tally& tally() const { return tally_; }

private:
    struct Entry {
        double predicted = 0;
        std::int32_t attempts = 0, failures = 0;
    };
    struct Running {
        std::uint32_t question = 0;
        std::int64_t number = 0;      ///< of the attempt
        std::optional<double> share;  ///< done, as last reported
    };
    using UnderWay = std::unordered_map<campaign::CaseId, Running>;
    struct GiveBacks {
        std::int64_t in_a_row = 0;
        double furthest = 0;  ///< share done when it was given back
    };

    /// Returns whether an earlier run stopped because its cases failed alike.
    [[nodiscard]] bool failed_before(std::span<const History> histories) const;
    /// Compares a failure with the first one.
    void compare_failure(campaign::Outcome outcome, std::string_view reason);
    /// Puts long cases first near the end of the queue, or near the last case that this run may settle.
    void order_the_end(std::span<const std::uint32_t> blocks);
    [[nodiscard]] std::size_t question_at(std::size_t placed) const {
        return places_.empty() ? placed : places_[placed];
    }
    [[nodiscard]] std::size_t placed() const { return places_.empty() ? entries_.size() : places_.size(); }
    [[nodiscard]] bool queue_is_empty() const { return returned_.empty() && head_ == queue_.size(); }
    /// Returns how many cases this run has begun.
    [[nodiscard]] std::size_t begun() const { return tally_.settled_now + tally_.failed_now + under_way_.size(); }
    [[nodiscard]] std::size_t queued() const { return returned_.size() + queue_.size() - head_; }
    [[nodiscard]] std::uint32_t front() const { return returned_.empty() ? queue_[head_] : returned_.back(); }
    [[nodiscard]] UnderWay::iterator find(const campaign::Attempt& attempt);
    [[nodiscard]] bool comes_no_further(const Running& one);
    void put_back(const Running& one);
    void decide(std::size_t question, campaign::Outcome outcome);

    std::function<campaign::Case(std::uint32_t question)> ask_;
    std::vector<Entry> entries_;
    std::vector<bool> decided_;  ///< settled or given up
    std::vector<std::uint32_t> places_;
    std::vector<std::uint32_t> queue_;  ///< from head_ on
    std::size_t head_ = 0;
    std::vector<std::uint32_t> returned_;  ///< cases given back; they run before the queue, the last one first
    UnderWay under_way_;
    std::unordered_map<std::uint32_t, GiveBacks> give_backs_;  ///< by question
    Rules rules_;
    Tally tally_;
    std::size_t prefix_ = 0;
    std::size_t left_out_ = 0;
    double shortest_left_out_ = 0;
    bool closed_ = false;
    bool may_be_alike_ = true;   ///< no case has an answer, and no failure differs from the first
    std::size_t alike_ = 0;      ///< failed cases
    std::string first_failure_;  ///< its outcome and reason without numbers
    std::size_t tried_again_ = 0;
};

}  // namespace grainsweep::schedule
