// Ticks of an axis and their labels.
#pragma once

#include "sweep/plot/plot.hpp"

#include <string>
#include <vector>

namespace grainsweep::plot {

struct Tick {
    double at = 0;
    std::string label;
};

/// Returns multiples of 1, 2 or 5 times a power of ten between two numbers, at most about `most`; all with the same
/// number of decimals.
[[nodiscard]] std::vector<Tick> round_ticks(double low, double high, int most);
/// Returns powers of ten, with 2 and 5 between them if there are few; at most about `most`. In less than a decade, or
/// if fewer than two remain, returns round_ticks.
[[nodiscard]] std::vector<Tick> log_ticks(double low, double high, int most);
/// Returns the ticks of any axis of numbers.
[[nodiscard]] std::vector<Tick> ticks_of(const Axis& axis, int most);
/// Returns 2 to 9 times each power of ten, for ticks without a label; empty if the axis is not logarithmic.
[[nodiscard]] std::vector<double> minor_ticks(const Axis& axis);

}  // namespace grainsweep::plot
