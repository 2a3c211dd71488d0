// Box whose faces are periodic or open, per axis.
//
// A pair across a periodic face is written with the image of j: its position plus a whole number of periods,
// -1, 0 or 1 per axis. The 27 images are numbered (ix + 1) + 3 (iy + 1) + 9 (iz + 1); number 13 is j itself.
#pragma once

#include "solver/geometry/vector.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>

namespace grainsweep::geometry {

struct Domain {
    Vec3 low{};
    Vec3 high{};
    std::array<bool, 3> periodic{};

    [[nodiscard]] double length(std::size_t axis) const { return high[axis] - low[axis]; }

    /// Returns the displacement (m, whole periods) that moves x into [low, high) along periodic axes.
    [[nodiscard]] Vec3 wrapping(const Vec3& x) const {
        Vec3 shift{};
        for (std::size_t k = 0; k < 3; ++k)
            if (periodic[k] && !(x[k] >= low[k] && x[k] < high[k]))
                shift[k] = -std::floor((x[k] - low[k]) / length(k)) * length(k);
        return shift;
    }

    /// Returns whether x is beyond an open face.
    [[nodiscard]] bool outside(const Vec3& x) const {
        for (std::size_t k = 0; k < 3; ++k)
            if (!periodic[k] && !(x[k] >= low[k] && x[k] <= high[k])) return true;
        return false;
    }

    /// Returns the shortest a - b of all images.
    [[nodiscard]] Vec3 separation(const Vec3& a, const Vec3& b) const {
        Vec3 d = a - b;
        for (std::size_t k = 0; k < 3; ++k)
            if (periodic[k]) d[k] -= std::round(d[k] / length(k)) * length(k);
        return d;
    }

    /// Returns the displacement (m) of each of the 27 images.
    [[nodiscard]] std::array<Vec3, 27> image_shifts() const {
        std::array<Vec3, 27> shifts{};
        for (std::size_t c = 0; c < 27; ++c) {
            const std::array<std::size_t, 3> n = {c % 3, c / 3 % 3, c / 9};
            for (std::size_t k = 0; k < 3; ++k)
                shifts[c][k] = periodic[k] ? (static_cast<double>(n[k]) - 1) * length(k) : 0.0;
        }
        return shifts;
    }
};

}  // namespace grainsweep::geometry
