// Where an axis has ticks, and what stands at them.
#pragma once

#include "sweep/plot/plot.hpp"

#include <string>
#include <vector>

namespace grainsweep::plot {

struct Tick {
    double at = 0;
    std::string label;
};

/// Multiples of 1, 2 or 5 times a power of ten between two numbers, at most about `most`; all with the same decimals.
[[nodiscard]] std::vector<Tick> round_ticks(double low, double high, int most);
/// Powers of ten, with 2 and 5 between them where those are few; at most about `most`. Within less than a decade and
/// where fewer than two remain, round_ticks.
[[nodiscard]] std::vector<Tick> log_ticks(double low, double high, int most);
/// Of any axis of numbers.
[[nodiscard]] std::vector<Tick> ticks_of(const Axis& axis, int most);
/// 2 to 9 times each power of ten, for ticks without a label; empty where the axis is not logarithmic.
[[nodiscard]] std::vector<double> minor_ticks(const Axis& axis);

}  // namespace grainsweep::plot
