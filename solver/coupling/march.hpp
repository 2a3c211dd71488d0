// Advance of a cloud by one time step, in blocks of particles. For each block it finds the cells, gathers the fluid
// values, and solves the equation of motion in vectors (motion.hpp). Blocks change no bit.
#pragma once

#include "solver/coupling/cloud.hpp"
#include "solver/coupling/motion.hpp"
#include "solver/threads/slabs.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <ranges>

namespace grainsweep::coupling {

/// Advances the particles in `order`. locate(p) returns the Stencil in the middle of the step, and gather(p, stencil)
/// the Surroundings. moved(p, velocity before) is called after the step of particle p. vibration: s(t) in the middle of
/// the step. Threads share the blocks, so these functions may access only data of particle p.
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

/// Advances the particles and reflects them at walls after `moved`.
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

/// Returns the predicted position of particle p in the middle of a step, X + V dt/2.
[[nodiscard]] inline Vec3 predicted(const Cloud& cloud, std::size_t p, double dt, const Walls& walls) {
    Vec3 x = cloud.position[p];
    for (std::size_t d = 0; d < 3; ++d) x[d] += 0.5 * dt * cloud.velocity[p][d];
    return walls.clipped(x);
}

/// Advances all particles in their own order; around(p) returns the Surroundings.
template <class Drag, class Around, class Moved>
void march_all(Cloud& cloud, const Motion<Drag>& motion, double vibration, Around around, Moved moved,
               const Slabs& slabs = {}) {
    march(
        cloud, motion, vibration, std::views::iota(std::size_t{0}, cloud.size()), [](std::size_t p) { return p; },
        [&](std::size_t p, std::size_t /*itself*/) { return around(p); }, moved, slabs);
}

}  // namespace grainsweep::coupling
