#include "solver/flow/shared_space.hpp"

#include "solver/flow/rows.hpp"
#include "solver/flow/vector_clones.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

namespace grainsweep::flow {
namespace {

// The fields of one component's row at i = 0.
struct Row {
    const double* mixture;               // J_d
    const double* velocity;              // V_d
    const double* solids;                // phi_p
    std::array<const double*, 3> all_j;  // J
    std::array<const double*, 3> all_v;  // V
    std::array<const double*, 3> all_m;  // phi V
    double viscosity;
};

// Returns the momentum flux of the clear fluid minus that of the shared one, through the low side of the control volume
// of component D at i. s, e: strides along D and E; gap, own: 1/distance of values along E and D.
template <int D, int E>
[[gnu::always_inline]] inline double flux_difference(const Row& r, std::ptrdiff_t i, std::ptrdiff_t s, std::ptrdiff_t e,
                                                     double lower, double upper, double gap, double own) {
    const double j_mean = 0.5 * (r.mixture[i - e] + r.mixture[i]);
    const double v_mean = 0.5 * (r.velocity[i - e] + r.velocity[i]);
    const double j_slope = (r.mixture[i] - r.mixture[i - e]) * gap;
    const double v_slope = (r.velocity[i] - r.velocity[i - e]) * gap;
    if constexpr (D == E) {
        const double m_mean = 0.5 * (r.all_m[E][i - e] + r.all_m[E][i]);
        const double fluid = 1 - r.solids[i - e];
        return j_mean * j_mean - m_mean * v_mean + r.viscosity * (fluid * 2 * v_slope - j_slope);
    } else {
        const double j_through = lower * r.all_j[E][i - s] + upper * r.all_j[E][i];
        const double m_through = lower * r.all_m[E][i - s] + upper * r.all_m[E][i];
        const double cross = (r.all_v[E][i] - r.all_v[E][i - s]) * own;
        const double fluid = 1 - 0.25 * (r.solids[i] + r.solids[i - e] + r.solids[i - s] + r.solids[i - s - e]);
        return j_through * j_mean - m_through * v_mean + r.viscosity * (fluid * (v_slope + cross) - j_slope);
    }
}

// Where a row of edges lies: the gap below it along E, and the shares and spacing along D.
struct EdgeRow {
    const double* gap_x;  // E = x
    const double* own_x;  // D = x, as the next two
    const double* lower_x;
    const double* upper_x;
    double gap, own, lower, upper;  // the same where the direction is not x
    std::ptrdiff_t s, e;            // strides along D and E
    int first, last;
};

// Flux difference through the low sides of a row of control volumes.
template <int D, int E>
GRAINSWEEP_VECTOR_CLONES void flux_row(double* __restrict flux, const Row& row, const EdgeRow& edge) {
    const Row r = row;
    const EdgeRow g = edge;
    const std::ptrdiff_t s = D == 0 ? 1 : g.s;
    const std::ptrdiff_t e = E == 0 ? 1 : g.e;
    for (int i = g.first; i <= g.last; ++i)
        flux[i] = flux_difference<D, E>(r, i, s, e, D == 0 ? g.lower_x[i] : g.lower, D == 0 ? g.upper_x[i] : g.upper,
                                        E == 0 ? g.gap_x[i] : g.gap, D == 0 ? g.own_x[i] : g.own);
}

// out += net inflow of the three pairs of fluxes.
GRAINSWEEP_VECTOR_CLONES
void balance_row(double* __restrict out, const double* __restrict x, const double* __restrict width_x,
                 const double* __restrict y_low, const double* __restrict y_high, double width_y,
                 const double* __restrict z_low, const double* __restrict z_high, double width_z, int first, int last) {
    for (int i = first; i <= last; ++i)
        out[i] += (x[i + 1] - x[i]) * width_x[i] + (y_high[i] - y_low[i]) * width_y + (z_high[i] - z_low[i]) * width_z;
}

template <int E>
void flux_row_of(int d, double* flux, const Row& row, const EdgeRow& edge) {
    if (d == 0)
        flux_row<0, E>(flux, row, edge);
    else if (d == 1)
        flux_row<1, E>(flux, row, edge);
    else
        flux_row<2, E>(flux, row, edge);
}

}  // namespace

SharedSpace::SharedSpace(const Grid& grid, const Sides& sides, double viscosity)
    : grid_(grid),
      cells_{grid.cells(0), grid.cells(1), grid.cells(2)},
      viscosity_(viscosity),
      edges_{velocity_edges(sides, 0), velocity_edges(sides, 1), velocity_edges(sides, 2)},
      weights_{Weights(grid, edges_[0]), Weights(grid, edges_[1]), Weights(grid, edges_[2])},
      velocity_(face_vectors(grid)),
      flux_(velocity_) {
    for (int d = 0; d < 3; ++d) {
        inverse_spacing_[at(d)].push_back(0);
        for (int i = 0; i <= cells_[at(d)] + 1; ++i) {
            inverse_width_[at(d)].push_back(1 / grid[d].width(i));
            if (i > 0) inverse_spacing_[at(d)].push_back(1 / grid[d].spacing(i));
        }
    }
}

void SharedSpace::fluid_flux(const FaceVectors& mixture, const FaceVectors& particle_flux, FaceVectors& flux) const {
    each_slab(slabs_, cells_, [&](const Planes& planes) {
        for (std::size_t d = 0; d < 3; ++d)
            set_planes(flux[d], planes,
                       [all = mixture[d].data(), particles = particle_flux[d].data()](std::ptrdiff_t m) {
                           return all[m] - particles[m];
                       });
    });
    fill_ghosts(flux, grid_, edges_, slabs_);
}

void SharedSpace::interstitial(const FaceVectors& mixture, const FaceVectors& particle_flux, const Field& solids,
                               FaceVectors& velocity) const {
    fluid_flux(mixture, particle_flux, velocity);
    each_slab(slabs_, cells_, [&](const Planes& planes) {
        for (int d = 0; d < 3; ++d) {
            const auto& first = weights_[at(d)].first;
            each_row(solids, first, cells_, planes, [&](std::ptrdiff_t row, int, int) {
                double* const v = velocity[at(d)].data() + row;
                const double* const here = solids.data() + row;
                const double* const below = here - solids.stride(d);
                for (int i = first[0]; i <= cells_[0]; ++i)
                    v[i] /= std::max(1 - 0.5 * (here[i] + below[i]), least_fluid);
            });
        }
    });
    fill_ghosts(velocity, grid_, edges_, slabs_);
}

void SharedSpace::add_excess(const FaceVectors& mixture, const FaceVectors& particle_flux, const Field& solids,
                             FaceVectors& acceleration) {
    fluid_flux(mixture, particle_flux, flux_);
    interstitial(mixture, particle_flux, solids, velocity_);
    rows_.resize(static_cast<std::size_t>(slabs_.count()));
    for (auto& of_slab : rows_)
        for (int d = 0; d < 3; ++d) prepare(d, of_slab[at(d)]);
    slabs_.each([&](int slab) {
        const int n = cells_[2];
        const Planes planes{1 + n * slab / slabs_.count(), n * (slab + 1) / slabs_.count()};
        for (int d = 0; d < 3; ++d)
            add_excess_of(d, mixture, solids, acceleration[at(d)], planes, rows_[at(slab)][at(d)]);
    });
}

// Values of component d lie at faces along d, at centres across it.
void SharedSpace::prepare(int d, FluxRows& rows) const {
    const auto length = at(cells_[0]) + 2;
    rows.gap_x.assign(1, 0);
    for (int i = 1; i <= cells_[0] + 1; ++i)
        rows.gap_x.push_back(d == 0 ? inverse_width_[0][at(i - 1)] : inverse_spacing_[0][at(i)]);
    for (auto* row : {&rows.x_low, &rows.y_low, &rows.y_high, &rows.z_high}) row->resize(length);
    rows.z_low.resize(length * (at(cells_[1]) + 2));  // a plane of rows
}

// Each flux is computed once: the high side of a row along y and z is the low side of the next row. Only at the first
// plane of a slab are the low sides along z computed again.
void SharedSpace::add_excess_of(int d, const FaceVectors& mixture, const Field& solids, Field& acceleration,
                                const Planes& planes, FluxRows& rows_of_slab) const {
    const auto m = at(d);
    const Weights& w = weights_[m];
    const Field& shape = mixture[m];
    const auto gap = [&](int e, int i) {  // below value i along e
        return e == d ? inverse_width_[at(e)][at(i - 1)] : inverse_spacing_[at(e)][at(i)];
    };
    auto& [gap_x, x_low, y_low, y_high, z_low, z_high] = rows_of_slab;
    // The low sides along E of the row (j, k), up to i = last.
    const auto find = [&]<int E>(std::integral_constant<int, E>, int j, int k, int last, double* flux) {
        const auto start = shape.index(0, j, k);
        const auto rows = [&](const FaceVectors& v) {
            return std::array<const double*, 3>{v[0].data() + start, v[1].data() + start, v[2].data() + start};
        };
        const Row row{mixture[m].data() + start,
                      velocity_[m].data() + start,
                      solids.data() + start,
                      rows(mixture),
                      rows(velocity_),
                      rows(flux_),
                      viscosity_};
        const auto along = at(d == 1 ? j : k);
        const bool x = d == 0;
        flux_row_of<E>(d, flux, row,
                       {gap_x.data(), inverse_spacing_[0].data(), w.lower[0].data(), w.upper[0].data(),
                        E == 0 ? 0 : gap(E, E == 1 ? j : k), x || d == E ? 0 : inverse_spacing_[m][along],
                        x || d == E ? 0 : w.lower[m][along], x || d == E ? 0 : w.upper[m][along], shape.stride(d),
                        shape.stride(E), w.first[0], last});
    };
    constexpr std::integral_constant<int, 0> along_x;
    constexpr std::integral_constant<int, 1> along_y;
    constexpr std::integral_constant<int, 2> along_z;
    const auto length = at(cells_[0]) + 2;
    const int first = std::max(w.first[2], planes.first);
    const int end = std::min(cells_[2], planes.last);
    if (first > end) return;
    for (int j = w.first[1]; j <= cells_[1]; ++j) find(along_z, j, first, cells_[0], &z_low[at(j) * length]);
    for (int k = first; k <= end; ++k) {
        find(along_y, w.first[1], k, cells_[0], y_low.data());
        for (int j = w.first[1]; j <= cells_[1]; ++j) {
            find(along_x, j, k, cells_[0] + 1, x_low.data());
            find(along_y, j + 1, k, cells_[0], y_high.data());
            find(along_z, j, k + 1, cells_[0], z_high.data());
            double* const below = &z_low[at(j) * length];
            balance_row(acceleration.data() + shape.index(0, j, k), x_low.data(), w.inverse_width[0].data(),
                        y_low.data(), y_high.data(), w.inverse_width[1][at(j)], below, z_high.data(),
                        w.inverse_width[2][at(k)], w.first[0], cells_[0]);
            std::swap(y_low, y_high);
            std::copy(z_high.begin(), z_high.end(), below);
        }
    }
}

}  // namespace grainsweep::flow
