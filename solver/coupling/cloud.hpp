// Particles of a suspension: equal spheres, one column per property.
#pragma once

#include "solver/coupling/walls.hpp"
#include "stats/random.hpp"

#include <cstddef>
#include <vector>

namespace grainsweep::coupling {

struct Cloud {
    std::vector<Vec3> position;
    std::vector<Vec3> velocity;

    [[nodiscard]] std::size_t size() const { return position.size(); }
};

/// Returns n particles at rest, with centres uniformly random in the permitted space; draw 3 p + d gives coordinate d
/// of particle p.
[[nodiscard]] inline Cloud random_cloud(std::size_t n, const Walls& walls, const stats::Stream& random) {
    Cloud cloud;
    for (std::size_t p = 0; p < n; ++p) {
        Vec3 x;
        for (std::size_t d = 0; d < 3; ++d) {
            const double margin = walls.periodic[d] ? 0 : walls.contact;
            x[d] = walls.low[d] + margin + (walls.high[d] - walls.low[d] - 2 * margin) * random.uniform(3 * p + d);
        }
        cloud.position.push_back(x);
        cloud.velocity.push_back({});
    }
    return cloud;
}

}  // namespace grainsweep::coupling
