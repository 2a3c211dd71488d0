// Moves a cloud through one time step, a block of particles at a time. It finds the cell of each particle, gathers the
// fluid there, and solves the equation of motion for the block in vectors (motion.hpp). Blocks
// change no bit: the same as one by one.
#pragma once

#include "solver/coupling/cloud.hpp"
#include "solver/coupling/motion.hpp"
#include "solver/threads/slabs.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <ranges>

namespace grainsweep::coupling {

/// `order` names the particles; locate(p) -> its Stencil in the middle of the step; gather(p, stencil) -> Surroundings;
/// moved(p, velocity before) follows the step of particle p. vibration: s(t) in the middle of the step, of all. Each of
/// them touches what is p's alone: blocks are shared among threads.
template <class Drag, class Order, class Locate, class Gather, class Moved>
void march(Cloud& cloud, const Motion<Drag>& motion, double vibration, const Order& order, Locate locate, Gather gather,
           Moved moved, const Slabs& slabs = {}) {
    const auto block = [&](std::size_t start, Lanes& lanes, auto& stencils) {
        const std::size_t count = std::min(Lanes::size, order.size() - start);
        for (std::size_t i = 0; i < count; ++i) stencils[i] = locate(order[start + i]);
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
    };
    const auto blocks = static_cast<std::ptrdiff_t>((order.size() + Lanes::size - 1) / Lanes::size);
    slabs.over(0, blocks - 1, [&](std::ptrdiff_t first, std::ptrdiff_t last) {
        Lanes lanes;
        std::array<decltype(locate(order[0])), Lanes::size> stencils;
        for (auto k = first; k <= last; ++k) block(static_cast<std::size_t>(k) * Lanes::size, lanes, stencils);
    });
}

/// ... and turned back by walls after `moved`.
template <class Drag, class Order, class Locate, class Gather, class Moved>
void march(Cloud& cloud, const Motion<Drag>& motion, const Walls& walls, double vibration, const Order& order,
           Locate locate, Gather gather, Moved moved, const Slabs& slabs = {}) {
    march(
        cloud, motion, vibration, order, locate, gather,
        [&](std::size_t p, const Vec3& before) {
            moved(p, before);
            walls.apply(cloud.position[p], cloud.velocity[p]);
        },
        slabs);
}

/// Where particle p is predicted in the middle of a step, X + V dt/2.
[[nodiscard]] inline Vec3 predicted(const Cloud& cloud, std::size_t p, double dt, const Walls& walls) {
    Vec3 x = cloud.position[p];
    for (std::size_t d = 0; d < 3; ++d) x[d] += 0.5 * dt * cloud.velocity[p][d];
    return walls.clipped(x);
}

/// All particles in their own order; around(p) -> Surroundings.
template <class Drag, class Around, class Moved>
void march_all(Cloud& cloud, const Motion<Drag>& motion, double vibration, Around around, Moved moved,
               const Slabs& slabs = {}) {
    march(
        cloud, motion, vibration, std::views::iota(std::size_t{0}, cloud.size()), [](std::size_t p) { return p; },
        [&](std::size_t p, std::size_t /*itself*/) { return around(p); }, moved, slabs);
}

}  // namespace grainsweep::coupling
