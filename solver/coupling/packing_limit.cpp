#include "solver/coupling/packing_limit.hpp"

#include "solver/coupling/each.hpp"

#include <algorithm>

namespace grainsweep::coupling {

PackingLimit::PackingLimit(const flow::Grid& grid, const flow::Sides& sides, double limit)
    : grid_(grid), edges_(frictionless_edges(sides)), limit_(limit), shift_(flow::face_vectors(grid)) {}

void PackingLimit::find_shift(int d, const flow::Field& fraction) {
    const double* const a = fraction.data();
    double* const shift = shift_[static_cast<std::size_t>(d)].data();
    const auto stride = fraction.stride(d);
    each_cell(grid_, slabs_, [&, stride](int i, int j, int k) {
        const auto here = fraction.index(i, j, k);
        const double below = std::max(a[here - stride] - limit_, 0.0);
        const double above = std::max(a[here] - limit_, 0.0);
        const double fullest = std::max(a[here], a[here - stride]);
        const int face = d == 0 ? i : d == 1 ? j : k;
        shift[here] = below == above ? 0 : grid_[d].spacing(face) * (below - above) / (6 * fullest);
    });
}

int PackingLimit::restore(std::vector<Vec3>& positions, const Walls& walls, SolidsVolume& solids) {
    int sweeps = 0;
    while (sweeps < most_sweeps && solids.largest_fraction() > 1.001 * limit_) {
        for (int d = 0; d < 3; ++d) find_shift(d, solids.fraction());
        fill_ghosts(shift_, grid_, edges_, slabs_);
        each_of(positions.size(), slabs_, [&](std::size_t p) {
            Vec3& x = positions[p];
            const Vec3 shift = Stencil<Trilinear>(grid_, walls.periodic, x).gather(shift_);
            if (shift[0] == 0 && shift[1] == 0 && shift[2] == 0) return;
            for (std::size_t d = 0; d < 3; ++d) x[d] += shift[d];
            x = walls.clipped(walls.inside(x));
        });
        solids.place(positions);
        ++sweeps;
    }
    return sweeps;
}

}  // namespace grainsweep::coupling
