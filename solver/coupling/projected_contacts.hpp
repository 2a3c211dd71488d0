// Four-way coupling without springs: in a viscous fluid a contact is where two spheres cannot go on.
//
// Collision Stokes numbers far below 10 allow no rebound (Joseph et al. 2001, doi 10.1017/S0022112001003470), so after
// each step overlaps are removed by sweeps over the pairs, half by each partner and wholly at walls, and the velocity
// changes by that displacement over the step (position-based dynamics, Mueller et al. 2007,
// doi 10.1016/j.jvcir.2007.01.005). The force that would have displaced a particle as far during the step,
//   f = (xi + 1/2) dx/(tau (dt - tau (1 - exp(-dt/tau)))),   tau = (xi + 1/2) St/Pr,
// is a contact's, not the fluid's, and is left out of what the fluid gets.
#pragma once

#include "solver/coupling/cloud.hpp"
#include "solver/coupling/march.hpp"
#include "solver/coupling/motion.hpp"
#include "solver/coupling/near_pairs.hpp"
#include "solver/coupling/solids_volume.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace grainsweep::coupling {

/// Removes overlaps by displacement; at most `sweeps` over all pairs.
class OverlapRemoval {
public:
    OverlapRemoval(const Walls& walls, double diameter) : walls_(walls), diameter_(diameter), near_(walls) {}

    /// Returns the largest overlap left, in diameters. displacement[p]: what p was moved by.
    double apply(std::vector<Vec3>& positions, std::vector<Vec3>& displacement, int sweeps);

private:
    Walls walls_;
    double diameter_;
    NearPairs near_;
};

class ProjectedContacts {
public:
    ProjectedContacts(const Sphere& sphere, const Walls& walls, double time_step);

    template <class Motion, class Feet, class Around>
    void move(Cloud& cloud, const Motion& motion, const Walls&, SolidsVolume&, const Feet&, const Around& around,
              std::vector<Vec3>& handed) {
        before_ = cloud.velocity;
        march_all(cloud, motion, around.vibration, around, [](std::size_t, const Vec3&) {});
        separate(cloud, motion.time_step(), handed);
    }
    void settle(Cloud&, const Walls&, SolidsVolume&) {}

    void save(std::vector<std::byte>&) const {}  // remembers nothing
    void restore(std::span<const std::byte>&) {}

private:
    void separate(Cloud& cloud, double time_step, std::vector<Vec3>& handed);

    double density_ratio_, force_per_displacement_;
    Walls walls_;
    OverlapRemoval removal_;
    std::vector<Vec3> before_, displacement_;
};

}  // namespace grainsweep::coupling
