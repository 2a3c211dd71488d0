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

TimeLeft::Seconds TimeLeft::estimate(double waiting, std::size_t workers, double now,
                                     const std::optional<std::vector<double>>& last) const {
    const double ratio = pace(now);
    Seconds seconds{taken_, ratio * waiting};
    std::vector<double> ends(workers, 0);  // s from now until each worker has finished its running cases
    std::vector<double> behind;            // s, of cases that wait behind a running case
    std::size_t busy = 0;
    const auto runs = [&](const Running& one, double begun) {
        seconds.done += now - begun;
        const double left = left_of(one, ratio, now);
        seconds.to_go += left;
        ends[busy++ % workers] += left;
    };
    // Of the cases without reports the oldest ones count as running, one per free worker; the others wait behind them.
    std::vector<const Running*> silent;
    for (const auto& [id, one] : running_)
        if (one.last)
            runs(one, one.first->at);
        else
            silent.push_back(&one);
    std::ranges::stable_sort(silent, {}, [](const Running* one) { return one->given; });
    for (const Running* one : silent) {
        if (busy < workers) {
            runs(*one, one->given);
            continue;
        }
        behind.push_back(ratio * one->predicted);
        seconds.to_go += behind.back();
    }
    if (!last || !(now > 0)) return seconds;
    for (const double predicted : *last) behind.push_back(ratio * predicted);
    for (const double length : behind) *std::ranges::min_element(ends) += length;
    seconds.to_go = std::max(seconds.to_go, std::ranges::max(ends) * seconds.done / now);
    return seconds;
}

}  // namespace grainsweep::schedule
