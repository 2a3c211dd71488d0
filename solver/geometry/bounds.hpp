// Boxes along the axes.
#pragma once

#include "solver/geometry/vector.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace grainsweep::geometry {

struct Bounds {
    Vec3 low{}, high{};

    /// Enlarges the box until it contains another one.
    void widen(const Bounds& other) {
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = std::min(low[k], other.low[k]);
            high[k] = std::max(high[k], other.high[k]);
        }
    }
    void widen(const Vec3& x) { widen(Bounds{x, x}); }
    /// Returns the corner of a number below 8: bit k says at which end it lies along axis k.
    [[nodiscard]] Vec3 corner(std::size_t number) const {
        Vec3 x = low;
        for (std::size_t k = 0; k < 3; ++k)
            if ((number >> k & 1U) != 0) x[k] = high[k];
        return x;
    }
};

/// Box that contains nothing, to be widened.
inline constexpr Bounds nowhere = [] {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    return Bounds{{infinity, infinity, infinity}, {-infinity, -infinity, -infinity}};
}();

/// Returns the box around points, of which there is at least one.
template <class Points>
[[nodiscard]] Bounds bounds_around(const Points& points) {
    Bounds box{points.front(), points.front()};
    for (const Vec3& x : points) box.widen(x);
    return box;
}

/// Returns what two boxes share: nothing where a lower end lies above the upper one.
[[nodiscard]] inline Bounds shared(Bounds one, const Bounds& other) {
    for (std::size_t k = 0; k < 3; ++k) {
        one.low[k] = std::max(one.low[k], other.low[k]);
        one.high[k] = std::min(one.high[k], other.high[k]);
    }
    return one;
}

}  // namespace grainsweep::geometry
