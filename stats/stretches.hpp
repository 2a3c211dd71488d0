// A growing sample cut into 8 consecutive stretches of equal length, and its statistics without each of them:
// what the delete-a-group jackknife (confidence.hpp) needs.
//
// The sample is kept sorted with the position of each value, so that all eight medians come from one walk over
// the sorted values instead of eight selections.
#pragma once

#include "stats/moments.hpp"

#include <array>
#include <cstddef>
#include <vector>

namespace grainsweep::stats {

class StretchedSample {
public:
    static constexpr std::size_t stretches = 8;

    /// Finite values only.
    void add(double value) { values_.push_back(value); }
    [[nodiscard]] std::size_t size() const { return values_.size(); }

    /// Entry g: the statistics of all values but those of positions n g/8 ... n (g+1)/8 - 1. At least 16 values.
    [[nodiscard]] std::array<Summary, stretches> leave_one_out();

private:
    struct Ranked {
        double value;
        std::size_t position;
    };

    [[nodiscard]] std::array<Middle, stretches> middles();
    [[nodiscard]] std::size_t first_of(std::size_t stretch) const { return values_.size() * stretch / stretches; }

    std::vector<double> values_;
    std::vector<Ranked> ranked_;  ///< sorted by value; what is new joins at the next question
};

}  // namespace grainsweep::stats
