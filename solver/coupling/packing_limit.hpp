// Nowhere more particle volume than random close packing.
//
// phi_p uses a kernel one diameter wide, or the cells where they are wider. With the fluid's kernel of four diameters,
// a thousand particles could share one place and still count as dilute.
//
// Where phi_p exceeds the limit the excess e = max(phi_p - limit, 0) diffuses away and takes the particles along:
// each pass over the faces moves the particles there by
//   x += h (e_below - e_above)/(6 phi_p),
// gathered between the faces; no excess, no motion. Its end is the state with phi_p <= limit that is nearest to the
// given one in the sense of an unstable sandpile. Only positions change, so momentum is untouched; walls are kept.
#pragma once

#include "solver/coupling/cloud.hpp"
#include "solver/coupling/solids_volume.hpp"

namespace grainsweep::coupling {

class PackingLimit {
public:
    PackingLimit(const flow::Grid& grid, const flow::Sides& sides, double limit);

    /// Threads that compute from now on; no bit depends on their number.
    void use(const Slabs& slabs) { slabs_ = slabs; }

    /// `solids` holds the fraction of `positions` before and after. Returns the number of sweeps: 0 where no cell is
    /// over the limit by more than 0.1 %, at most `most_sweeps`.
    int restore(std::vector<Vec3>& positions, const Walls& walls, SolidsVolume& solids);

    static constexpr int most_sweeps = 200;

private:
    flow::Grid grid_;
    std::array<flow::Edges, 3> edges_;
    double limit_;
    // Of the particles at the faces of component d.
    void find_shift(int d, const flow::Field& fraction);

    flow::FaceVectors shift_;
    Slabs slabs_;
};

}  // namespace grainsweep::coupling
