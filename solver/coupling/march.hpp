// A cloud moved through one time step, a block of particles at a time: the place of each on the grid is found first,
// then the fluid there is gathered, and the equation of motion is solved for the block in vectors (motion.hpp). Blocks
// change no bit: the same as one by one.
#pragma once

#include "solver/coupling/cloud.hpp"
#include "solver/coupling/motion.hpp"

#include <algorithm>
#include <cstddef>
#include <ranges>
#include <vector>

namespace grainsweep::coupling {

/// `order` names the particles; locate(p) -> its Stencil in the middle of the step; gather(p, stencil) -> Surroundings;
/// moved(p, velocity before) follows the step of particle p. vibration: s(t) in the middle of the step, of all.
template <class Drag, class Order, class Locate, class Gather, class Moved>
void march(Cloud& cloud, const Motion<Drag>& motion, double vibration, const Order& order, Locate locate, Gather gather,
           Moved moved) {
    Lanes lanes;
    std::vector<decltype(locate(order[0]))> stencils;
    stencils.reserve(Lanes::size);
    for (std::size_t start = 0; start < order.size(); start += Lanes::size) {
        const std::size_t count = std::min(Lanes::size, order.size() - start);
        stencils.clear();
        for (std::size_t i = 0; i < count; ++i) stencils.push_back(locate(order[start + i]));
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t p = order[start + i];
            const Surroundings around = gather(p, stencils[i]);
            for (std::size_t d = 0; d < 3; ++d) {
                lanes.position[d][i] = cloud.position[p][d];
                lanes.velocity[d][i] = cloud.velocity[p][d];
                lanes.fluid_velocity[d][i] = around.velocity[d];
                lanes.pull[d][i] = 1.5 * around.acceleration[d] + around.other[d];
            }
        }
        motion.advance(lanes, count, vibration);
        for (std::size_t i = 0; i < count; ++i) {
            const std::size_t p = order[start + i];
            const Vec3 before = cloud.velocity[p];
            for (std::size_t d = 0; d < 3; ++d) {
                cloud.position[p][d] = lanes.position[d][i];
                cloud.velocity[p][d] = lanes.velocity[d][i];
            }
            moved(p, before);
        }
    }
}

/// ... and turned back by walls after `moved`.
template <class Drag, class Order, class Locate, class Gather, class Moved>
void march(Cloud& cloud, const Motion<Drag>& motion, const Walls& walls, double vibration, const Order& order,
           Locate locate, Gather gather, Moved moved) {
    march(cloud, motion, vibration, order, locate, gather, [&](std::size_t p, const Vec3& before) {
        moved(p, before);
        walls.apply(cloud.position[p], cloud.velocity[p]);
    });
}

/// All particles in their own order; around(p) -> Surroundings.
template <class Drag, class Around, class Moved>
void march_all(Cloud& cloud, const Motion<Drag>& motion, double vibration, Around around, Moved moved) {
    march(
        cloud, motion, vibration, std::views::iota(std::size_t{0}, cloud.size()), [](std::size_t p) { return p; },
        [&](std::size_t p, std::size_t /*itself*/) { return around(p); }, moved);
}

}  // namespace grainsweep::coupling
