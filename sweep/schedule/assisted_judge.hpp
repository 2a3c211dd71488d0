// Checks of the rule `assisted`: they fit models, which takes seconds, so they are made on a thread beside the run.
//
// A check is over the cases below its points, whenever it is made: what it says depends on neither the time nor the
// number of workers. While it is under way the run goes on; what was computed beyond the point where the campaign
// turns out to have converged is kept and does not count, as under every rule.
#pragma once

#include "stats/assisted_convergence.hpp"
#include "sweep/campaign/cases.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <future>
#include <span>
#include <vector>

namespace grainsweep::schedule {

/// What models see of the cases.
struct ModelView {
    stats::ModelSpace space;
    std::function<std::vector<double>(std::size_t point)> features;  ///< of a point of the design
};

class AssistedJudge {
public:
    /// `stops`: nothing is checked after the check that converged. Throws std::invalid_argument as
    /// stats::AssistedConvergence does.
    AssistedJudge(stats::ConvergenceSettings settings, ModelView view, campaign::Cases placed, bool stops);

    /// Adds the value at a place of the cases (NaN: the case failed). Places come in their order; some may be left out.
    void add(std::size_t place, double value);
    /// Every point below `points` has been added or will never be.
    void settle(std::int64_t points) { settled_ = points; }
    /// Takes what is finished and begins the check that is due, if any. `wait`: until none is.
    void advance(bool wait);
    /// A check is under way.
    [[nodiscard]] bool busy() const { return under_way_.valid(); }

    /// Finished checks.
    [[nodiscard]] std::span<const stats::Checkpoint> checkpoints() const { return finished_; }
    [[nodiscard]] const stats::Checkpoint* converged() const;
    /// Points of the first check.
    [[nodiscard]] std::int64_t first_check() const { return first_check_; }

private:
    void begin();

    stats::AssistedConvergence convergence_;  ///< of the thread while a check is under way
    std::function<std::vector<double>(std::size_t point)> features_of_;
    campaign::Cases placed_;
    bool stops_;
    std::int64_t first_check_, due_, settled_ = 0;
    std::vector<std::int64_t> points_;
    std::vector<double> values_, features_;
    std::size_t dimensions_;
    std::vector<stats::Checkpoint> finished_;
    std::future<void> under_way_;  // last: it is waited for before what it uses goes
};

}  // namespace grainsweep::schedule
