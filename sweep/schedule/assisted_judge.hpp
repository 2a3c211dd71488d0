// Checks of the rule `assisted`. A check fits models, which takes seconds, so it is made on a thread of its own.
//
// A check uses only the cases below its number of points. Its verdict therefore depends neither on the time nor on the
// number of workers. The run continues during a check. Cases computed beyond the point of convergence are kept but do
// not count, as under every rule.
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

/// Inputs of the models.
struct ModelView {
    stats::ModelSpace space;
    std::function<std::vector<double>(std::size_t point)> features;  ///< of a point of the design
};

class AssistedJudge {
public:
    /// `stops`: no check is made after the one that converged. Throws std::invalid_argument as
    /// stats::AssistedConvergence does.
    AssistedJudge(stats::ConvergenceSettings settings, ModelView view, campaign::Cases placed, bool stops);

    /// Adds the value at a place of the cases (NaN: the case failed). Places come in their order; some may be left out.
    void add(std::size_t place, double value);
    /// States that every point below `points` has been added or never will be.
    void settle(std::int64_t points) { settled_ = points; }
    /// Takes the result of a finished check and starts the check that is due, if any. `wait`: waits until no check is
    /// due.
    void advance(bool wait);
    /// Returns whether a check is being made.
    [[nodiscard]] bool busy() const { return under_way_.valid(); }

    /// Returns the finished checks.
    [[nodiscard]] std::span<const stats::Checkpoint> checkpoints() const { return finished_; }
    [[nodiscard]] const stats::Checkpoint* converged() const;
    /// Returns the number of points of the first check.
    [[nodiscard]] std::int64_t first_check() const { return first_check_; }

private:
    void begin();

    stats::AssistedConvergence convergence_;  ///< used by the thread alone while a check is being made
    std::function<std::vector<double>(std::size_t point)> features_of_;
    campaign::Cases placed_;
    bool stops_;
    std::int64_t first_check_, due_, settled_ = 0;
    std::vector<std::int64_t> points_;
    std::vector<double> values_, features_;
    std::size_t dimensions_;
    std::vector<stats::Checkpoint> finished_;
    std::future<void> under_way_;  // last member: its destructor waits for the thread before the members that the
                                   // thread uses are destroyed
};

}  // namespace grainsweep::schedule
