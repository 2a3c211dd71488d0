#include "sweep/workers/thread_choice.hpp"

#include <algorithm>

namespace grainsweep::workers {

int ThreadChoice::next(int allowed) {
    allowed_ = allowed;
    if (slices_ == period || allowed >= 2 * allowed_in_trials_ || 2 * allowed <= allowed_in_trials_) slices_ = 0;
    if (slices_ == 0) {
        rate_ = {};
        allowed_in_trials_ = allowed;
    }
    if (slices_ < trials.size()) chosen_ = trials[slices_];
    return chosen_ == all ? allowed : chosen_ == half ? std::max(1, allowed / 2) : 1;
}

void ThreadChoice::note(double work, double seconds) {
    if (allowed_ == 1) return;
    if (slices_ < trials.size())
        rate_[chosen_] += work / seconds / static_cast<double>(std::ranges::count(trials, chosen_));
    if (++slices_ != trials.size()) return;
    constexpr double clearly_faster = 1.05;
    chosen_ = all;
    for (const Candidate fewer : {half, one})
        if (rate_[fewer] > clearly_faster * rate_[chosen_]) chosen_ = fewer;
}

}  // namespace grainsweep::workers
