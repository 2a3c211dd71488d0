// Four-way coupling without springs: in a viscous fluid a contact only stops the approach of two spheres.
//
// Collision Stokes numbers far below 10 allow no rebound (Joseph et al. 2001, doi 10.1017/S0022112001003470). So after
// each step, passes through the pairs remove overlaps, half by each partner and wholly at walls. The velocity changes
// by that displacement divided by the step (position-based dynamics, Mueller et al. 2007, doi
// 10.1016/j.jvcir.2007.01.005). The momentum that a particle needs over the step to
// end dx further and dx/dt faster, against its inertia and its drag, whose integral knows the displacement alone,
//   f dt = (xi + 1/2) dx/dt + (xi + 1/2)/tau dx   per volume,   tau that of its step (motion.hpp),
// is a contact's, not the fluid's, and is left out of what the fluid gets: what rests on a wall gives it nothing. Two
// spheres push each other alike, with the mean of their tau^-1.
#pragma once

#include "solver/coupling/cloud.hpp"
#include "solver/coupling/march.hpp"
#include "solver/coupling/motion.hpp"
#include "solver/coupling/near_pairs.hpp"
#include "solver/coupling/solids_volume.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace grainsweep::coupling {

/// Removes overlaps by displacement; at most `sweeps` over all pairs.
class OverlapRemoval {
public:
    OverlapRemoval(const Walls& walls, double diameter) : walls_(walls), diameter_(diameter), near_(walls) {}

    /// i was moved by `by`; j, where it is no wall, by the opposite.
    struct Move {
        static constexpr std::uint32_t wall = 0xFFFFFFFFU;
        std::uint32_t i, j;
        Vec3 by;
    };

    /// Returns the largest overlap left, in diameters.
    double apply(std::vector<Vec3>& positions, int sweeps);
    /// Of the last apply, in their order.
    [[nodiscard]] const std::vector<Move>& moves() const { return moves_; }

private:
    Walls walls_;
    double diameter_;
    NearPairs near_;
    std::vector<Move> moves_;
};

class ProjectedContacts {
public:
    ProjectedContacts(const Sphere& sphere, const Walls& walls);
    /// Threads that compute from now on; no bit depends on their number.
    void use(const Slabs& slabs) { slabs_ = slabs; }

    template <class Motion, class Stencils, class Around>
    void move(Cloud& cloud, const Motion& motion, const Walls&, SolidsVolume&, const Stencils&, const Around& around,
              std::vector<Vec3>& transmitted) {
        before_ = cloud.velocity;
        surroundings_.resize(cloud.size());
        march_all(
            cloud, motion, around.vibration, [&](std::size_t p) { return surroundings_[p] = around(p); },
            [](std::size_t, const Vec3&) {}, slabs_);
        const auto tau = [&](std::size_t p) { return motion.step_relaxation(before_[p], surroundings_[p]); };
        separate(cloud, motion.time_step(), tau, transmitted);
    }
    void settle(Cloud&, const Walls&, SolidsVolume&) {}

    void save(std::vector<std::byte>&) const {}  // there is no history
    void restore(std::span<const std::byte>&) {}

private:
    // tau(p) is evaluated only for particles that were moved.
    template <class Tau>
    void separate(Cloud& cloud, double time_step, Tau tau, std::vector<Vec3>& transmitted) {
        if (!remove_overlaps(cloud)) return;  // the run reports it
        stiffness_.assign(cloud.size(), 0);
        force_.assign(cloud.size(), Vec3{});
        const auto stiffness = [&](std::uint32_t p) {
            if (stiffness_[p] == 0) stiffness_[p] = (density_ratio_ + 0.5) * (1 / time_step + 1 / tau(p)) / time_step;
            return stiffness_[p];
        };
        for (const auto& [i, j, by] : removal_.moves()) {
            const bool wall = j == OverlapRemoval::Move::wall;
            const double k = wall ? stiffness(i) : 0.5 * (stiffness(i) + stiffness(j));  // f/dx
            for (std::size_t d = 0; d < 3; ++d) {
                force_[i][d] += k * by[d];
                cloud.velocity[i][d] += by[d] / time_step;
                if (wall) continue;
                force_[j][d] -= k * by[d];
                cloud.velocity[j][d] -= by[d] / time_step;
            }
        }
        const double inertia = density_ratio_ / time_step;
        for (std::size_t p = 0; p < cloud.size(); ++p) {
            for (std::size_t d = 0; d < 3; ++d)
                transmitted[p][d] = force_[p][d] - inertia * (cloud.velocity[p][d] - before_[p][d]);
            cloud.position[p] = walls_.clipped(cloud.position[p]);
        }
    }
    /// False, and nothing done: a position is no number.
    bool remove_overlaps(Cloud& cloud);

    double density_ratio_;
    Walls walls_;
    OverlapRemoval removal_;
    std::vector<Vec3> before_, force_;
    std::vector<double> stiffness_;  // f/dx of the particles asked for, else 0
    std::vector<Surroundings> surroundings_;
    Slabs slabs_;
};

}  // namespace grainsweep::coupling
