// Reflection of particles at the sides of the box.
#pragma once

#include "solver/coupling/interpolation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace grainsweep::coupling {

/// Planes at distance `contact` inside the sides (the radius, or 0 for a contact of the centre). The displacement
/// beyond a plane and the normal velocity are reversed and multiplied by the restitution.
/// Periodic axes wrap.
struct Walls {
    std::array<double, 3> low{}, high{};
    std::array<bool, 3> periodic{};
    double contact = 0;
    double restitution = 1;

    void apply(Vec3& x, Vec3& v) const {
        for (std::size_t d = 0; d < 3; ++d) {
            if (periodic[d]) {
                const double length = high[d] - low[d];
                if (x[d] < low[d] || x[d] >= high[d]) x[d] -= length * std::floor((x[d] - low[d]) / length);
                continue;
            }
            const double bottom = low[d] + contact;
            const double top = high[d] - contact;
            if (x[d] < bottom) {
                x[d] = std::min(bottom + restitution * (bottom - x[d]), top);
                v[d] *= -restitution;
            } else if (x[d] > top) {
                x[d] = std::max(top - restitution * (x[d] - top), bottom);
                v[d] *= -restitution;
            }
        }
    }

    /// Returns the position limited to between the contact planes; periodic axes do not change.
    [[nodiscard]] Vec3 inside(Vec3 x) const {
        for (std::size_t d = 0; d < 3; ++d)
            if (!periodic[d]) x[d] = std::clamp(x[d], low[d] + contact, high[d] - contact);
        return x;
    }

    /// Returns the position limited to the closed box between the contact planes.
    [[nodiscard]] Vec3 clipped(Vec3 x) const {
        for (std::size_t d = 0; d < 3; ++d)
            if (!periodic[d])
                x[d] = std::clamp(x[d], low[d], high[d]);
            else if (x[d] < low[d] || x[d] >= high[d])
                x[d] -= (high[d] - low[d]) * std::floor((x[d] - low[d]) / (high[d] - low[d]));
        return x;
    }
};

}  // namespace grainsweep::coupling
