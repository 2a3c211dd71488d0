#include "solver/coupling/projected_contacts.hpp"

#include <algorithm>
#include <cmath>

namespace grainsweep::coupling {

using namespace geometry;

double OverlapRemoval::apply(std::vector<Vec3>& positions, std::vector<Vec3>& displacement, int sweeps) {
    displacement.assign(positions.size(), Vec3{});
    const auto hold = [&](std::size_t p) {
        const Vec3 held = walls_.inside(positions[p]);
        displacement[p] += held - positions[p];
        positions[p] = held;
    };
    for (std::size_t p = 0; p < positions.size(); ++p) hold(p);
    // Partners that could come to touch while the others are moved.
    std::vector<Vec3> wrapped = positions;
    for (Vec3& x : wrapped) x = walls_.clipped(x);
    const auto& pairs = near_.find(wrapped, 1.25 * diameter_);
    double largest = 0;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        largest = 0;
        for (const auto& [i, j] : pairs) {
            const Vec3 branch = near_.separation(positions[i], positions[j]);
            const double distance = std::sqrt(dot(branch, branch));
            const double overlap = diameter_ - distance;
            if (!(overlap > 0)) continue;
            largest = std::max(largest, overlap / diameter_);
            const Vec3 n = distance > 0 ? (1 / distance) * branch : Vec3{0, 0, 1};
            const Vec3 half = (0.5 * overlap) * n;
            positions[i] += half;
            positions[j] -= half;
            displacement[i] += half;
            displacement[j] -= half;
            hold(i);
            hold(j);
        }
        if (largest < 1e-9) break;
    }
    return largest;
}

ProjectedContacts::ProjectedContacts(const Sphere& sphere, const Walls& walls, double time_step)
    : density_ratio_(sphere.density_ratio), walls_(walls), removal_(walls, 2 * sphere.radius()) {
    const double mass = sphere.density_ratio + 0.5;
    const double tau = mass * sphere.stokes / sphere.prandtl;
    const double ratio = time_step / tau;
    // dt/tau - (1 - exp(-dt/tau)), by its series where that cancels.
    const double reach = ratio > 1e-3 ? ratio + std::expm1(-ratio) : ratio * ratio * (0.5 - ratio / 6);
    force_per_displacement_ = mass / (tau * tau * reach);
}

void ProjectedContacts::separate(Cloud& cloud, double time_step, std::vector<Vec3>& handed) {
    for (const Vec3& x : cloud.position)
        if (!std::isfinite(x[0] + x[1] + x[2])) return;  // the run will say so
    removal_.apply(cloud.position, displacement_, 10);
    for (std::size_t p = 0; p < cloud.size(); ++p) {
        Vec3& v = cloud.velocity[p];
        v += (1 / time_step) * displacement_[p];
        handed[p] = force_per_displacement_ * displacement_[p] - (density_ratio_ / time_step) * (v - before_[p]);
        cloud.position[p] = walls_.clipped(cloud.position[p]);
    }
}

}  // namespace grainsweep::coupling
