#include "solver/observables/flow_state.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace grainsweep::observables {
namespace {

std::size_t at(int i) {
    return static_cast<std::size_t>(i);
}

// Width of the control volumes of component d along axis e; a wall face owns half a cell.
std::vector<double> control_widths(const flow::Grid& grid, int d, int e) {
    std::vector<double> widths{0};
    const flow::Axis& axis = grid[e];
    for (int i = 1; i <= axis.cells(); ++i) widths.push_back(d == e ? axis.spacing(i) : axis.width(i));
    return widths;
}

}  // namespace

double kinetic_energy(const flow::Grid& grid, const flow::FaceVectors& velocity) {
    double energy = 0;
    for (int d = 0; d < 3; ++d) {
        const flow::Field& v = velocity[at(d)];
        const auto wx = control_widths(grid, d, 0);
        const auto wy = control_widths(grid, d, 1);
        const auto wz = control_widths(grid, d, 2);
        for (int k = 1; k <= grid.cells(2); ++k)
            for (int j = 1; j <= grid.cells(1); ++j) {
                const double* const row = v.data() + v.index(0, j, k);
                double sum = 0;
                for (int i = 1; i <= grid.cells(0); ++i) sum += wx[at(i)] * row[i] * row[i];
                energy += 0.5 * sum * wy[at(j)] * wz[at(k)];
            }
    }
    return energy / (grid[0].length() * grid[1].length() * grid[2].length());
}

double peak_velocity(const flow::Grid& grid, const flow::FaceVectors& velocity) {
    double peak = 0;
    for (const flow::Field& v : velocity)
        for (int k = 1; k <= grid.cells(2); ++k)
            for (int j = 1; j <= grid.cells(1); ++j) {
                const double* const row = v.data() + v.index(0, j, k);
                for (int i = 1; i <= grid.cells(0); ++i) peak = std::max(peak, std::abs(row[i]));
            }
    return peak;
}

double nusselt(const flow::Grid& grid, const flow::Field& temperature, int d, int side, double wall) {
    const int a = d == 0 ? 1 : 0;
    const int b = d == 2 ? 1 : 2;
    const int n = side == 0 ? 1 : grid.cells(d);
    double sum = 0;
    for (int q = 1; q <= grid.cells(b); ++q)
        for (int p = 1; p <= grid.cells(a); ++p) {
            const double inside =
                temperature.data()[p * temperature.stride(a) + q * temperature.stride(b) + n * temperature.stride(d)];
            sum += (wall - inside) / (0.5 * grid[d].width(n)) * grid[a].width(p) * grid[b].width(q);
        }
    return std::abs(sum) * grid[d].length() / (grid[a].length() * grid[b].length());
}

double gershuni(double prandtl, double rayleigh, double frequency) {
    const double ratio = rayleigh / frequency;
    return 0.5 * prandtl * ratio * ratio;
}

}  // namespace grainsweep::observables
