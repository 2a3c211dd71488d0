#include "sweep/schedule/time_left.hpp"

#include <algorithm>
#include <vector>

namespace grainsweep::schedule {
namespace {

// Of a case that has not ended, at least so much of its length is left.
constexpr double least_left = 0.05;

}  // namespace

void TimeLeft::begun(const campaign::Attempt& attempt, double predicted, double now) {
    running_.insert_or_assign(attempt.case_id, Running{attempt.number, predicted, now, {}, {}});
}

TimeLeft::Cases::iterator TimeLeft::find(const campaign::Attempt& attempt) {
    const auto found = running_.find(attempt.case_id);
    return found != running_.end() && found->second.number == attempt.number ? found : running_.end();
}

void TimeLeft::reported(const campaign::Attempt& attempt, double share, double now) {
    const auto found = find(attempt);
    if (found == running_.end() || !(share >= 0 && share <= 1)) return;
    Running& one = found->second;
    if (!one.first) one.first = one.number > 1 ? Report{share, now} : Report{0, one.given};
    one.last = Report{share, now};
}

void TimeLeft::ended(const campaign::Attempt& attempt, double taken, double now) {
    const auto found = find(attempt);
    if (found == running_.end()) return;
    const Running& one = found->second;
    taken_ += taken;
    predicted_ += one.predicted * (1 - (one.first ? one.first->share : 0));
    if (one.last) {
        end_shares_ += one.predicted * std::min(1.0, one.last->share + speed(one) * (now - one.last->at));
        shared_ += one.predicted;
    }
    running_.erase(found);
}

double TimeLeft::speed(const Running& one) {
    const double seconds = one.last->at - one.first->at;
    return seconds > 0 ? (one.last->share - one.first->share) / seconds : 0;
}

double TimeLeft::pace(double now) const {
    double taken = taken_, predicted = predicted_;
    for (const auto& [id, one] : running_) {
        if (!one.last) continue;
        taken += now - one.first->at;
        predicted += one.predicted * std::min(1.0, (one.last->share - one.first->share) / last_share());
    }
    return predicted > 0 ? taken / predicted : 1;
}

double TimeLeft::left_of(const Running& one, double pace, double now) const {
    const double whole = pace * one.predicted;
    if (!one.last) return std::max(whole - (now - one.given), least_left * whole);
    const double share = std::min(1.0, one.last->share / last_share());
    const double by_pace = whole * std::max(1 - share, least_left);
    const double per_second = speed(one) / last_share();
    if (!(per_second > 0)) return by_pace;
    const double own = std::max(1 - share, least_left) / per_second;
    return share * own + (1 - share) * by_pace;
}

TimeLeft::Seconds TimeLeft::estimate(double waiting, std::size_t workers, double now) const {
    const double ratio = pace(now);
    Seconds seconds{taken_, ratio * waiting};
    // Of those that report nothing the oldest run, one per worker; the others wait behind them.
    std::vector<const Running*> silent;
    std::size_t busy = 0;
    double longest = 0;
    for (const auto& [id, one] : running_) {
        if (!one.last) {
            silent.push_back(&one);
            continue;
        }
        ++busy;
        seconds.done += now - one.first->at;
        const double left = left_of(one, ratio, now);
        longest = std::max(longest, left);
        seconds.to_go += left;
    }
    std::ranges::stable_sort(silent, {}, [](const Running* one) { return one->given; });
    for (const Running* one : silent) {
        const bool runs = busy < workers;
        if (runs) {
            ++busy;
            seconds.done += now - one->given;
        }
        seconds.to_go += runs ? left_of(*one, ratio, now) : ratio * one->predicted;
    }
    // No worker shortens the longest case: the others have nothing left to do meanwhile.
    if (now > 0) seconds.to_go = std::max(seconds.to_go, longest * seconds.done / now);
    return seconds;
}

}  // namespace grainsweep::schedule
