// Four-way coupling without springs. In a viscous fluid a contact only stops the approach of two spheres.
//
// At collision Stokes numbers far below 10 there is no rebound (Joseph et al. 2001, doi 10.1017/S0022112001003470).
// After each step, passes through the pairs remove overlaps: each partner moves by half of the overlap, and at walls
// the particle moves by all of it. The velocity changes by the displacement divided by the step (position-based
// dynamics, Mueller et al. 2007, doi 10.1016/j.jvcir.2007.01.005). A displacement dx and a velocity change dx/dt,
// against inertia and drag, need the momentum
//   f dt = (xi + 1/2) dx/dt + (xi + 1/2)/tau dx   per volume,   tau of the step (motion.hpp).
// This momentum comes from the contact and is not part of the force on the fluid: a particle resting on a wall exerts
// no force on the fluid. The forces of two spheres on each other are opposite, with the mean of their tau^-1.
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

/// Removal of overlaps by displacement.
class OverlapRemoval {
public:
    OverlapRemoval(const Walls& walls, double diameter) : walls_(walls), diameter_(diameter), near_(walls) {}

    /// Displacement of i by `by`, and of j, unless it is a wall, by the opposite.
    struct Move {
        static constexpr std::uint32_t wall = 0xFFFFFFFFU;
        std::uint32_t i, j;
        Vec3 by;
    };

    /// Removes overlaps in at most `sweeps` passes over all pairs. Returns the largest remaining overlap, in diameters.
    double apply(std::vector<Vec3>& positions, int sweeps);
    /// Returns the displacements of the last apply(), in their order.
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
    /// Sets the threads that compute; no bit depends on their number.
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
    // Removes overlaps; tau(p) is evaluated only for displaced particles.
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
    /// Returns false without any change if a position is NaN.
    bool remove_overlaps(Cloud& cloud);

    double density_ratio_;
    Walls walls_;
    OverlapRemoval removal_;
    std::vector<Vec3> before_, force_;
    std::vector<double> stiffness_;  // f/dx of displaced particles, else 0
    std::vector<Surroundings> surroundings_;
    Slabs slabs_;
};

}  // namespace grainsweep::coupling
