#include "solver/geometry/triangle.hpp"

#include <cmath>

namespace grainsweep::geometry {

Triangle Triangle::of(std::array<Vec3, 3> corners) {
    std::ranges::sort(corners);
    Triangle t{corners, {}};
    // Of the two sides at the corner opposite to the longest one: the fewest digits cancel.
    const std::array<Vec3, 3> side = {corners[1] - corners[0], corners[2] - corners[1], corners[0] - corners[2]};
    std::size_t longest = 0;
    for (std::size_t k = 1; k < 3; ++k)
        if (dot(side[k], side[k]) > dot(side[longest], side[longest])) longest = k;
    const Vec3 n = cross(side[(longest + 1) % 3], side[(longest + 2) % 3]);
    t.normal = (1 / norm(n)) * n;
    return t;
}

Nearest Triangle::nearest(const Vec3& x) const {
    if (below(x)) {
        const double h = height(x);
        return {x - h * normal, std::abs(h), Feature::face, 0};
    }
    constexpr std::array<std::array<std::uint8_t, 2>, 3> ends = {{{0, 1}, {1, 2}, {0, 2}}};
    Nearest best;
    double least = 0;
    for (std::uint8_t k = 0; k < 3; ++k) {
        const Vec3& a = corner[ends[k][0]];
        const Vec3& b = corner[ends[k][1]];
        const Vec3 along = b - a;
        const double share = dot(x - a, along) / dot(along, along);
        Nearest on{a, 0, Feature::vertex, ends[k][0]};
        if (share >= 1) {
            on.point = b;
            on.number = ends[k][1];
        } else if (share > 0) {
            on = {a + share * along, 0, Feature::edge, k};
        }
        const Vec3 apart = x - on.point;
        const double r2 = dot(apart, apart);
        if (k > 0 && r2 >= least) continue;
        least = r2;
        best = on;
    }
    best.distance = std::sqrt(least);
    return best;
}

}  // namespace grainsweep::geometry
