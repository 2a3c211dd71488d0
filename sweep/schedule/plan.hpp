// What to compute next, what a result means, when to give up. Pure: sees no process, clock or archive.
//
// Work is per question: cases that stand at several places of a design are computed once. Order is the design's, so
// that the finished part is always a usable prefix. Long cases go first only where they would otherwise be what the end
// waits for: where what is left is less than a few times the longest case on every worker.
#pragma once

#include "sweep/campaign/case.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

namespace grainsweep::schedule {

/// What the archive knew of a question when the run began.
struct History {
    std::int32_t attempts = 0;  ///< highest attempt number
    std::int32_t failures = 0;  ///< of those, crashed or timed out
    std::optional<campaign::Outcome> outcome = {};
    bool asked =
        true;  ///< by this run; false: of a larger design that is stored, counted in the prefix, never computed
};

struct Rules {
    std::int64_t attempts = 3;     ///< tries of a case that crashes or times out
    std::int64_t give_backs = 10;  ///< times in this run that a case may come back no further than before
    std::optional<std::int64_t> stop_after_failures = {};  ///< start nothing more after so many failed cases
    std::optional<std::int64_t> max_cases = {};            ///< settle at most so many in this run
    std::optional<campaign::Outcome> again = {};           ///< ask again what ended like this
    std::size_t workers = 1;                               ///< how many cases are computed at once
};

/// The different cases of a plan: a repeated case stands here once.
struct Questions {
    std::function<campaign::Case(std::uint32_t question)> ask;
    std::vector<History> histories;
    std::vector<double> predicted;  ///< seconds
    /// Index of the question of each placed case. Empty: place i has question i.
    std::vector<std::uint32_t> places;
    /// Number of the block after which the campaign may stop, growing; no case is brought forward out of a later block
    /// than the design is in. Empty: nothing stops it.
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
    /// The next attempt to start, if there is one now.
    [[nodiscard]] std::optional<Start> next();
    /// Predicted seconds of what next() would return; nothing when there is nothing.
    [[nodiscard]] std::optional<double> next_predicted() const;
    /// How many next() could return one after the other now.
    [[nodiscard]] std::size_t waiting() const;

    /// Predicted seconds of those, in their order, where they are not more than `most`.
    [[nodiscard]] std::optional<std::vector<double>> last_predicted(std::size_t most) const;

    /// Predicted seconds of a running attempt; 0: it is not running.
    [[nodiscard]] double predicted(const campaign::Attempt& attempt) const;
    [[nodiscard]] std::size_t workers() const { return rules_.workers; }
    /// Of a running attempt: those predicted, less what it has done. 0: it is not running.
    [[nodiscard]] double seconds_left(const campaign::Attempt& attempt) const;
    /// A running attempt has come so far, 0 to 1.
    void advanced(const campaign::Attempt& attempt, double share);

    enum class Verdict { settled, again, gave_up, stale };
    /// A running attempt ended so.
    Verdict ended(const campaign::Attempt& attempt, campaign::Outcome outcome);
    /// It was given back unfinished, which costs no try: the question returns to the head of the queue. One that comes
    /// back again and again without getting further is given up in this run.
    Verdict given_back(const campaign::Attempt& attempt);
    /// It was handed out but no worker began it: the same, and its number is free again.
    void never_begun(const campaign::Attempt& attempt);
    /// Start none that is predicted to take longer than this, in this run.
    void leave_out_longer_than(double seconds);
    [[nodiscard]] std::size_t left_out() const { return left_out_; }
    /// Of those the shortest prediction, seconds.
    [[nodiscard]] double shortest_left_out() const { return shortest_left_out_; }
    /// Start nothing more.
    void close() { closed_ = true; }

    [[nodiscard]] bool too_many_failures() const {
        return rules_.stop_after_failures && std::cmp_greater_equal(tally_.failed_now, *rules_.stop_after_failures);
    }
    /// Nothing running and nothing that could still be started.
    [[nodiscard]] bool over() const { return under_way_.empty() && !next_predicted(); }
    /// Length of the longest prefix of the placed cases all of whose questions are decided.
    [[nodiscard]] std::size_t settled_prefix();

    struct Tally {
        std::size_t questions = 0;
        std::size_t decided = 0;       ///< settled or given up, before or in this run
        std::size_t settled_now = 0;   ///< completed or skipped in this run
        std::size_t failed_now = 0;    ///< given up, unstable or rejected in this run
        std::size_t failed = 0;        ///< given up or settled as unstable or rejected, in all runs
        double predicted_waiting = 0;  ///< seconds, of what this run may still start
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

    /// Long cases first near the end: of the queue or of what this run may settle.
    void order_the_end(std::span<const std::uint32_t> blocks);
    [[nodiscard]] std::size_t question_at(std::size_t placed) const {
        return places_.empty() ? placed : places_[placed];
    }
    [[nodiscard]] std::size_t placed() const { return places_.empty() ? entries_.size() : places_.size(); }
    [[nodiscard]] bool queue_is_empty() const { return returned_.empty() && head_ == queue_.size(); }
    /// In this run.
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
    std::vector<std::uint32_t> returned_;  ///< before the queue, the last one first
    UnderWay under_way_;
    std::unordered_map<std::uint32_t, GiveBacks> give_backs_;  ///< by question, of those that were given back
    Rules rules_;
    Tally tally_;
    std::size_t prefix_ = 0;
    std::size_t left_out_ = 0;
    double shortest_left_out_ = 0;
    bool closed_ = false;
};

}  // namespace grainsweep::schedule
