// Record of a TPMS discharge: counts and speeds at each sample, contact forces, and whether the powder has come to
// rest.
#pragma once

#include "solver/bytes.hpp"
#include "solver/dem/engine.hpp"
#include "solver/scenes/tpms/question.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace grainsweep {

/// Measurements at one moment.
struct Moment {
    std::int64_t step = 0;
    std::int64_t in_cell = 0;  ///< mobile centres in the cell
    double fastest_down = 0;   ///< in the cell, along gravity, m/s; 0: no particle moves down; NaN: the cell is empty
    std::int64_t mobile = 0;   ///< not yet removed
    std::int64_t at_rest = 0;  ///< in the cell, slower than quiet_speed
};

/// Bin of a histogram at a step.
struct Bin {
    std::int64_t step = 0;
    double centre = 0;
    double share = 0;
};

class TpmsRecord {
public:
    /// start: number of mobile particles at time 0. The question must outlive the record.
    TpmsRecord(const TpmsQuestion& question, std::int64_t start) : question_(&question), start_(start) {}

    void add(const Moment& now);
    /// Adds the largest contact force, and with `histograms` the distributions of overlaps and forces.
    void add(std::span<const dem::ContactForce> contacts, std::int64_t step, bool histograms);

    /// Returns whether the powder has been at rest for the time that the rule "quiet" requires.
    [[nodiscard]] bool is_quiet(std::int64_t step) const;
    /// Returns the time at which the retention first fell to a share, in t*; NaN: it never did.
    [[nodiscard]] double time_to(double share) const;
    void observe(Observations& into) const;

    void save(ByteWriter& out) const;
    void restore(ByteReader& in);

private:
    [[nodiscard]] double in_t_star(double step) const;

    const TpmsQuestion* question_;
    std::int64_t start_;
    std::int64_t quiet_since_ = 0;  // step of the last sample that was not quiet
    std::int64_t quiet_count_ = 0;  // particles in the cell at that step
    double max_force_ = 0;          // m 9.81
    std::vector<Moment> moments_;
    std::vector<Bin> overlaps_, forces_;
};

}  // namespace grainsweep
