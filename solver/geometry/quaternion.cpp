#include "solver/geometry/quaternion.hpp"

#include <algorithm>
#include <numbers>

namespace grainsweep::geometry {

Quaternion orientation_of(const std::array<Vec3, 3>& axes) {
    const auto& [x, y, z] = axes;  // columns of the matrix
    // Of the squares of four times the parts the largest is at least 1, so that nothing cancels.
    const std::array<double, 4> squares = {1 + x[0] + y[1] + z[2], 1 + x[0] - y[1] - z[2], 1 - x[0] + y[1] - z[2],
                                           1 - x[0] - y[1] + z[2]};
    const auto largest = std::ranges::max_element(squares) - squares.begin();
    const double s = squares[static_cast<std::size_t>(largest)];
    Quaternion q{};
    switch (largest) {
        case 0:
            q = {s, y[2] - z[1], z[0] - x[2], x[1] - y[0]};
            break;
        case 1:
            q = {y[2] - z[1], s, x[1] + y[0], z[0] + x[2]};
            break;
        case 2:
            q = {z[0] - x[2], x[1] + y[0], s, y[2] + z[1]};
            break;
        default:
            q = {x[1] - y[0], z[0] + x[2], y[2] + z[1], s};
    }
    return normalised(q);
}

Quaternion orientation_at(double u1, double u2, double u3) {
    const double a = std::sqrt(1 - u1), b = std::sqrt(u1);
    const double s = 2 * std::numbers::pi * u2, t = 2 * std::numbers::pi * u3;
    return {b * std::cos(t), a * std::sin(s), a * std::cos(s), b * std::sin(t)};
}

}  // namespace grainsweep::geometry
