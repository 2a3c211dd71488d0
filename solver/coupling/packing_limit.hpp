// Limit of the particle volume in every cell: random close packing.
//
// phi_p uses a kernel one diameter wide, or as wide as a cell if that is wider. With the fluid's kernel of four
// diameters, a thousand particles at one place would still count as dilute.
//
// The excess e = max(phi_p - limit, 0) diffuses and moves the particles with it. Each pass over the faces moves the
// particles there by
//   x += h (e_below - e_above)/(6 phi_p),
// gathered between the faces. The result is the nearest state with phi_p <= limit in the sense of an unstable sandpile.
// Only positions change, so momentum is conserved. Particles do not pass walls.
#pragma once

#include "solver/coupling/cloud.hpp"
#include "solver/coupling/solids_volume.hpp"

namespace grainsweep::coupling {

class PackingLimit {
public:
    PackingLimit(const flow::Grid& grid, const flow::Sides& sides, double limit);

    /// Sets the threads that compute; no bit depends on their number.
    void use(const Slabs& slabs) { slabs_ = slabs; }

    /// Applies the limit. `solids` has the fraction of `positions` before and after. Returns the number of passes, at
    /// most `most_sweeps`; 0 if no cell exceeds the limit by more than 0.1 %.
    int restore(std::vector<Vec3>& positions, const Walls& walls, SolidsVolume& solids);

    static constexpr int most_sweeps = 200;

private:
    flow::Grid grid_;
    std::array<flow::Edges, 3> edges_;
    double limit_;
    // Computes the displacement of particles at the faces of component d.
    void find_shift(int d, const flow::Field& fraction);

    flow::FaceVectors shift_;
    Slabs slabs_;
};

}  // namespace grainsweep::coupling
