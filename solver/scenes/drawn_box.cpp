#include "solver/scenes/drawn_box.hpp"

namespace grainsweep {

std::int32_t add_box(const std::array<double, 3>& low, const std::array<double, 3>& high, WallSurface& surface) {
    const auto first = static_cast<std::int32_t>(surface.corners.size());
    for (std::size_t corner = 0; corner < 8; ++corner) {
        std::array<double, 3> x = low;
        for (std::size_t axis = 0; axis < 3; ++axis)
            if ((corner >> axis & 1U) != 0) x[axis] = high[axis];
        surface.corners.push_back(x);
    }
    for (std::int32_t corner = 0; corner < 8; ++corner)
        for (const std::int32_t bit : {1, 2, 4})
            if ((corner & bit) == 0) surface.edges.push_back({first + corner, first + corner + bit});
    return first;
}

}  // namespace grainsweep
