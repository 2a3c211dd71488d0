#include "solver/coupling/interpolation.hpp"

#include <utility>
#include <vector>

namespace grainsweep::coupling {
namespace {

template <class Body>
void each_line(const flow::Field& field, const flow::Grid& grid, int d, Body body) {
    const int a = d == 0 ? 1 : 0;
    const int b = d == 2 ? 1 : 2;
    for (int q = 0; q <= grid.cells(b) + 1; ++q)
        for (int p = 0; p <= grid.cells(a) + 1; ++p) body(p * field.stride(a) + q * field.stride(b));
}

}  // namespace

void fold_ghosts(flow::Field& field, const flow::Grid& grid, const flow::Edges& edges) {
    for (int d = 2; d >= 0; --d) {  // the reverse of the order in which ghosts are filled
        const flow::Edge& edge = edges[static_cast<std::size_t>(d)];
        const int n = grid.cells(d);
        const auto stride = field.stride(d);
        double* const values = field.data();
        each_line(field, grid, d, [&](std::ptrdiff_t line) {
            double& low = values[line];
            double& high = values[line + (n + 1) * stride];
            if (edge.periodic) {
                values[line + n * stride] += std::exchange(low, 0.0);
                values[line + stride] += std::exchange(high, 0.0);
            } else if (edge.on_faces) {
                values[line + 2 * stride] -= std::exchange(low, 0.0);
                values[line + stride] = 0;
                high = 0;
            } else {
                values[line + stride] += edge.ghost[0].sign * std::exchange(low, 0.0);
                values[line + n * stride] += edge.ghost[1].sign * std::exchange(high, 0.0);
            }
        });
    }
}

void smooth(flow::Field& field, const flow::Grid& grid, const flow::Edges& edges, int passes) {
    for (int pass = 0; pass < passes; ++pass)
        for (int d = 0; d < 3; ++d) {
            const flow::Edge& edge = edges[static_cast<std::size_t>(d)];
            const int first = flow::first_unknown(edge);
            const int n = grid.cells(d);
            if (n - first < 1) continue;
            const auto stride = field.stride(d);
            double* const values = field.data();
            each_line(field, grid, d, [&](std::ptrdiff_t line) {
                double* const v = values + line;
                double before = edge.periodic ? v[n * stride] : v[first * stride];
                const double beyond = edge.periodic ? v[first * stride] : v[n * stride];
                for (int m = first; m <= n; ++m) {
                    const double here = v[m * stride];
                    const double after = m < n ? v[(m + 1) * stride] : beyond;
                    v[m * stride] = 0.25 * (before + after) + 0.5 * here;
                    before = here;
                }
            });
        }
}

}  // namespace grainsweep::coupling
