// Growing sample cut into 8 consecutive batches of equal length, and its statistics without each of them, for the
// delete-a-group jackknife (confidence.hpp).
//
// The sample is stored sorted, with the position of each value, so that one pass gives all eight medians.
#pragma once

#include "stats/moments.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace grainsweep::stats {

class StretchedSample {
public:
    static constexpr std::size_t batches = 8;

    /// Adds a finite value.
    void add(double value) { values_.push_back(value); }
    [[nodiscard]] std::size_t size() const { return values_.size(); }

    /// Returns in entry g the statistics of all values except positions n g/8 ... n (g+1)/8 - 1. Requires at least 16
    /// values.
    [[nodiscard]] std::array<Summary, batches> leave_one_out();

private:
    struct Ranked {
        double value;
        std::size_t position;
    };

    [[nodiscard]] std::array<Middle, batches> middles();
    [[nodiscard]] std::size_t first_of(std::size_t stretch) const { return values_.size() * stretch / batches; }

    std::vector<double> values_;
    std::vector<Ranked> ranked_;  ///< sorted by value; new values are merged at the next call of leave_one_out()
};

}  // namespace grainsweep::stats
