#include "solver/coupling/packing_limit.hpp"

#include <algorithm>

namespace grainsweep::coupling {
PackingLimit::PackingLimit(const flow::Grid& grid, const flow::Sides& sides, double limit)
    : grid_(grid), edges_(frictionless_edges(sides)), limit_(limit), shift_(flow::face_vectors(grid)) {}

void PackingLimit::find_shift(int d, const flow::Field& fraction, int first, int last) {
    const double* const a = fraction.data();
    const auto m = static_cast<std::size_t>(d);
    const auto stride = fraction.stride(d);
    for (int k = first; k <= last; ++k)
        for (int j = 1; j <= grid_.cells(1); ++j)
            for (int i = 1; i <= grid_.cells(0); ++i) {
                const auto here = fraction.index(i, j, k);
                const double below = std::max(a[here - stride] - limit_, 0.0);
                const double above = std::max(a[here] - limit_, 0.0);
                const double fullest = std::max(a[here], a[here - stride]);
                const int face = d == 0 ? i : d == 1 ? j : k;
                shift_[m].data()[here] = below == above ? 0 : grid_[d].spacing(face) * (below - above) / (6 * fullest);
            }
}

int PackingLimit::restore(std::vector<Vec3>& positions, const Walls& walls, SolidsVolume& solids) {
    int sweeps = 0;
    while (sweeps < most_sweeps && solids.largest_fraction() > 1.001 * limit_) {
        slabs_.over(1, grid_.cells(2), [&](std::ptrdiff_t first, std::ptrdiff_t last) {
            for (int d = 0; d < 3; ++d)
                find_shift(d, solids.fraction(), static_cast<int>(first), static_cast<int>(last));
        });
        fill_ghosts(shift_, grid_, edges_, slabs_);
        const auto move = [&](Vec3& x) {
            const Vec3 shift = Stencil<Trilinear>(grid_, walls.periodic, x).gather(shift_);
            if (shift[0] == 0 && shift[1] == 0 && shift[2] == 0) return;
            for (std::size_t d = 0; d < 3; ++d) x[d] += shift[d];
            x = walls.clipped(walls.inside(x));
        };
        slabs_.over(0, static_cast<std::ptrdiff_t>(positions.size()) - 1,
                    [&](std::ptrdiff_t first, std::ptrdiff_t last) {
                        for (auto p = first; p <= last; ++p) move(positions[static_cast<std::size_t>(p)]);
                    });
        solids.place(positions);
        ++sweeps;
    }
    return sweeps;
}

}  // namespace grainsweep::coupling
