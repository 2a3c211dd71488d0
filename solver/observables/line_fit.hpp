// Straight line through points, z = height + slope x, by least squares of z.
//
//     slope = sum (x - xm)(z - zm)/sum (x - xm)^2,   height = zm - slope xm
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>

namespace grainsweep::observables {

struct Line {
    double slope = std::numeric_limits<double>::quiet_NaN();
    double height = std::numeric_limits<double>::quiet_NaN();    ///< at x = 0
    double residual = std::numeric_limits<double>::quiet_NaN();  ///< root mean square distance in z from the line
};

/// Returns the line through points (x, z). NaN if fewer than two points differ in x; slope exactly 0 if all z are
/// equal.
[[nodiscard]] inline Line fitted_line(std::span<const std::array<double, 2>> points) {
    const auto n = static_cast<double>(points.size());
    double xm = 0, zm = 0, xx = 0, xz = 0;
    for (const auto& [x, z] : points) xm += x / n, zm += z / n;
    for (const auto& [x, z] : points) xx += (x - xm) * (x - xm), xz += (x - xm) * (z - zm);
    if (!(xx > 0)) return {};
    const auto level = [first = points.front()[1]](const auto& point) { return point[1] == first; };
    if (std::ranges::all_of(points, level)) return {0, points.front()[1], 0};
    Line line{xz / xx, zm - xz / xx * xm, 0};
    for (const auto& [x, z] : points) {
        const double off = z - line.height - line.slope * x;
        line.residual += off * off / n;
    }
    line.residual = std::sqrt(line.residual);
    return line;
}

}  // namespace grainsweep::observables
