// Measurements of a thermovibration case, and its answer.
#pragma once

#include "solver/coupling/cloud.hpp"
#include "solver/coupling/levels.hpp"
#include "solver/flow/flow.hpp"
#include "solver/scenes/thermovibration/question.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace grainsweep::thermovibration {

/// Averages of the flow over a window of steps.
struct FlowMeans {
    double energy = 0;   ///< mean of |V|^2/2 in volume and window
    double nusselt = 0;  ///< of the hot wall, mean in the window
    double peak = 0;     ///< largest |V_d| in the window

    /// Adds the state after one of `window` steps.
    void add(const flow::Flow<flow::Boussinesq>& fluid, std::int64_t window);
};

/// Root mean squares, in a window of steps, of the momentum exchanged by the particles (levels that act on the fluid).
struct BudgetMeans {
    double given = 0, drive = 0;  ///< mean squares so far

    /// Adds one of `window` steps.
    void add(const coupling::MomentumBudget& budget, std::int64_t window) {
        given += budget.given * budget.given / static_cast<double>(window);
        drive += budget.drive * budget.drive / static_cast<double>(window);
    }
};

class Record {
public:
    explicit Record(const Question& question);

    /// Samples the particles at time t, always at the same phase of the vibration.
    void sample(double t, const coupling::Cloud& cloud);
    void set_flow(const FlowMeans& means) { flow_ = means; }
    void set_budget(const BudgetMeans& means) { budget_ = means; }
    /// Sets the share of the steps so far in which the packing limit moved particles.
    void set_limited_share(double share) { limited_share_ = share; }

    void observe(Observations& into) const;
    void save(std::vector<std::byte>& into) const;
    void restore(std::span<const std::byte>& from);

private:
    [[nodiscard]] std::size_t sampling_total() const;

    Question question_;
    std::optional<FlowMeans> flow_;
    std::optional<BudgetMeans> budget_;
    std::optional<double> limited_share_;
    std::vector<double> times_, k_, k5_, k20_, k40_, k_cells_;
    std::vector<coupling::Vec3> last_;  ///< positions of the last sample
};

}  // namespace grainsweep::thermovibration
