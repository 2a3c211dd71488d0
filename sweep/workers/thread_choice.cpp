#include "sweep/workers/thread_choice.hpp"

#include <algorithm>

namespace grainsweep::workers {

int ThreadChoice::threads_of(std::size_t candidate) const {
    return candidate == 0 ? allowed_ : candidate == 1 ? std::max(1, allowed_ / 2) : 1;
}

int ThreadChoice::next(int allowed) {
    if (allowed != allowed_) *this = ThreadChoice{};
    allowed_ = allowed;
    return threads_of(chosen_);
}

void ThreadChoice::note(double work, double seconds) {
    if (allowed_ == 1) return;
    constexpr int all_trials = trials * static_cast<int>(candidates);
    if (timed_ < all_trials) rate_[chosen_] += work / seconds;
    if (++timed_ < all_trials) {
        chosen_ = static_cast<std::size_t>(timed_ / trials);
    } else if (timed_ == all_trials) {
        constexpr double clearly_faster = 1.05;
        chosen_ = 0;
        for (std::size_t fewer = 1; fewer < candidates; ++fewer)
            if (rate_[fewer] > clearly_faster * rate_[chosen_]) chosen_ = fewer;
    } else if (timed_ >= period) {
        timed_ = 0;
        chosen_ = 0;
        rate_ = {};
    }
}

}  // namespace grainsweep::workers
