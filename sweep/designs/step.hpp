// Values of a factor at multiples of a step, counted from 0: a gap in steps of 0.5 mm, a whole number of blades.
//
// m_1 ... m_2: multiples within the range. The range is widened to [(m_1 - 1/2) step, (m_2 + 1/2) step], and every
// value of the widened range is rounded to the nearest multiple. So each multiple has a complete cell, also the first
// and the last, and no value lies outside the range. In a linear range all multiples are equally likely. In a
// logarithmic range each has the probability of its cell, proportional to log((m + 1/2)/(m - 1/2)).
//
// The values of a distribution are rounded to the nearest multiple, so each multiple has the probability of its cell.
// The first and the last inside its ends have what lies beyond them, too.
#pragma once

#include "sweep/designs/factor.hpp"

#include <cstdint>

namespace grainsweep::designs {

/// Numbers of the first and last multiple of a step within [low, high]; last < first: there is none.
struct Multiples {
    std::int64_t first = 0, last = -1;
    [[nodiscard]] std::int64_t count() const { return last - first + 1; }
};

/// Largest number of multiples.
inline constexpr std::int64_t most_multiples = 1'000'000'000;

/// Returns number * step as the double nearest to the decimal product: 3 * 0.1 is 0.3.
[[nodiscard]] double multiple_of(double step, std::int64_t number);
/// Finds the multiples within a range. Needs step > 0 and at most `most_multiples` steps from 0 to either end.
[[nodiscard]] Multiples multiples_in(double step, double low, double high);
/// Returns whether x is a multiple, to the last bit.
[[nodiscard]] bool is_multiple(double step, double x);
/// Returns the multiple at the coordinate u in [0, 1] of a range that has at least one.
[[nodiscard]] double stepped(const Between& range, double step, double u);
[[nodiscard]] double stepped(const stats::Distribution& distribution, double step, double u);

}  // namespace grainsweep::designs
