#include "solver/coupling/projected_contacts.hpp"

#include <algorithm>
#include <cmath>

namespace grainsweep::coupling {

using namespace geometry;

double OverlapRemoval::apply(std::vector<Vec3>& positions, int sweeps) {
    moves_.clear();
    const auto hold = [&](std::uint32_t p) {
        const Vec3 held = walls_.inside(positions[p]);
        if (held == positions[p]) return;
        moves_.push_back({p, Move::wall, held - positions[p]});
        positions[p] = held;
    };
    for (std::uint32_t p = 0; p < positions.size(); ++p) hold(p);
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
            moves_.push_back({i, j, half});
            hold(i);
            hold(j);
        }
        if (largest < 1e-9) break;
    }
    return largest;
}

ProjectedContacts::ProjectedContacts(const Sphere& sphere, const Walls& walls)
    : density_ratio_(sphere.density_ratio), walls_(walls), removal_(walls, 2 * sphere.radius()) {}

bool ProjectedContacts::remove_overlaps(Cloud& cloud) {
    for (const Vec3& x : cloud.position)
        if (!std::isfinite(x[0] + x[1] + x[2])) return false;
    removal_.apply(cloud.position, 10);
    return true;
}

}  // namespace grainsweep::coupling
