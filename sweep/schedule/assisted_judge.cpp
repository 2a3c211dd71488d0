#include "sweep/schedule/assisted_judge.hpp"

#include <algorithm>
#include <chrono>
#include <stdexcept>
#include <utility>

namespace grainsweep::schedule {

AssistedJudge::AssistedJudge(stats::ConvergenceSettings settings, ModelView view, campaign::Cases placed, bool stops)
    : convergence_(std::move(settings), std::move(view.space)),
      features_of_(std::move(view.features)),
      placed_(std::move(placed)),
      stops_(stops),
      first_check_(convergence_.next_check()),
      due_(first_check_),
      dimensions_(convergence_.dimensions()) {}

void AssistedJudge::add(std::size_t place, double value) {
    const std::size_t point = placed_.place(place).point;
    const auto features = features_of_(point);
    if (features.size() != dimensions_) throw std::invalid_argument("a case has another number of features");
    points_.push_back(static_cast<std::int64_t>(point));
    values_.push_back(value);
    features_.insert(features_.end(), features.begin(), features.end());
}

const stats::Checkpoint* AssistedJudge::converged() const {
    const auto found = std::ranges::find(finished_, true, &stats::Checkpoint::converged);
    return found == finished_.end() ? nullptr : &*found;
}

void AssistedJudge::advance(bool wait) {
    while (true) {
        if (busy()) {
            if (!wait && under_way_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
            under_way_.get();
            finished_.push_back(convergence_.checkpoints().back());
            due_ = convergence_.next_check();
        }
        if (due_ > settled_ || (stops_ && converged() != nullptr)) return;
        begin();
        if (!wait) return;
    }
}

void AssistedJudge::begin() {
    const auto rows = std::ranges::lower_bound(points_, due_) - points_.begin();
    const auto numbers = rows * static_cast<std::ptrdiff_t>(dimensions_);
    under_way_ =
        std::async(std::launch::async, [this, points = std::vector(points_.begin(), points_.begin() + rows),
                                        values = std::vector(values_.begin(), values_.begin() + rows),
                                        features = std::vector(features_.begin(), features_.begin() + numbers)] {
            convergence_.check(points, values, features);
        });
}

}  // namespace grainsweep::schedule
