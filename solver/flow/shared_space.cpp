#include "solver/flow/shared_space.hpp"

#include "solver/flow/vector_clones.hpp"

#include <algorithm>

namespace grainsweep::flow {
namespace {

std::size_t at(int i) {
    return static_cast<std::size_t>(i);
}

// The geometry of one direction at one place: the control volume and the two gaps between values on its sides.
struct Across {
    std::ptrdiff_t step;
    double inverse_width, low_gap, high_gap;
};

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

// Momentum flux of the clear fluid less that of the shared one, through the low side of the control volume of
// component D at i; s: stride along D, e: stride along E, gap: 1/distance of values along E, own: the same along D.
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

struct RowGeometry {
    const double* inverse_width_x;  // of the control volumes of component D along x
    const double* gap_x;            // gap_x[i]: below value i along x
    const double* own_x;            // D = 0: spacing along x at the face
    const double* lower_x;
    const double* upper_x;
    Across y, z;
    double own, lower, upper;  // along D when that is y or z
    std::ptrdiff_t sy, sz;
    int first, last;
};

template <int D>
GRAINSWEEP_VECTOR_CLONES void excess_row(double* __restrict out, const Row& row, const RowGeometry& g) {
    const Row r = row;
    const double* const width_x = g.inverse_width_x;
    const double* const gap_x = g.gap_x;
    const double* const own_x = g.own_x;
    const double* const lower_x = g.lower_x;
    const double* const upper_x = g.upper_x;
    const Across y = g.y;
    const Across z = g.z;
    const double own_d = g.own;
    const double lower_d = g.lower;
    const double upper_d = g.upper;
    const std::ptrdiff_t s = D == 0 ? 1 : D == 1 ? g.sy : g.sz;
    const int last = g.last;
    for (int i = g.first; i <= last; ++i) {
        const double lower = D == 0 ? lower_x[i] : lower_d;
        const double upper = D == 0 ? upper_x[i] : upper_d;
        const double own = D == 0 ? own_x[i] : own_d;
        out[i] += (flux_difference<D, 0>(r, i + 1, s, 1, lower, upper, gap_x[i + 1], own) -
                   flux_difference<D, 0>(r, i, s, 1, lower, upper, gap_x[i], own)) *
                      width_x[i] +
                  (flux_difference<D, 1>(r, i + y.step, s, y.step, lower, upper, y.high_gap, own) -
                   flux_difference<D, 1>(r, i, s, y.step, lower, upper, y.low_gap, own)) *
                      y.inverse_width +
                  (flux_difference<D, 2>(r, i + z.step, s, z.step, lower, upper, z.high_gap, own) -
                   flux_difference<D, 2>(r, i, s, z.step, lower, upper, z.low_gap, own)) *
                      z.inverse_width;
    }
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
    for (std::size_t d = 0; d < 3; ++d) {
        for (std::size_t m = 0; m < flux[d].size(); ++m)
            flux[d].values()[m] = mixture[d].values()[m] - particle_flux[d].values()[m];
        fill_ghosts(flux[d], grid_, edges_[d]);
    }
}

void SharedSpace::interstitial(const FaceVectors& mixture, const FaceVectors& particle_flux, const Field& solids,
                               FaceVectors& velocity) const {
    fluid_flux(mixture, particle_flux, velocity);
    for (int d = 0; d < 3; ++d) {
        Field& v = velocity[at(d)];
        const auto& weights = weights_[at(d)];
        for (int k = weights.first[2]; k <= cells_[2]; ++k)
            for (int j = weights.first[1]; j <= cells_[1]; ++j)
                for (int i = weights.first[0]; i <= cells_[0]; ++i) {
                    const auto here = solids.index(i, j, k);
                    const double phi_p = 0.5 * (solids.data()[here] + solids.data()[here - solids.stride(d)]);
                    v.data()[here] /= std::max(1 - phi_p, least_fluid);
                }
        fill_ghosts(v, grid_, edges_[at(d)]);
    }
}

void SharedSpace::add_excess(const FaceVectors& mixture, const FaceVectors& particle_flux, const Field& solids,
                             FaceVectors& acceleration) {
    fluid_flux(mixture, particle_flux, flux_);
    interstitial(mixture, particle_flux, solids, velocity_);
    for (int d = 0; d < 3; ++d) {
        const auto m = at(d);
        const Weights& w = weights_[m];
        const Field& shape = mixture[m];
        // Values of component d lie at faces along d, at centres across it.
        const auto gap = [&](int e, int i) {  // below value i along e
            return e == d ? inverse_width_[at(e)][at(i - 1)] : inverse_spacing_[at(e)][at(i)];
        };
        std::vector<double> gap_x{0};
        for (int i = 1; i <= cells_[0] + 1; ++i) gap_x.push_back(gap(0, i));
        for (int k = w.first[2]; k <= cells_[2]; ++k)
            for (int j = w.first[1]; j <= cells_[1]; ++j) {
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
                const int along = d == 1 ? j : k;
                const RowGeometry g{w.inverse_width[0].data(),
                                    gap_x.data(),
                                    inverse_spacing_[0].data(),
                                    w.lower[0].data(),
                                    w.upper[0].data(),
                                    {shape.stride(1), w.inverse_width[1][at(j)], gap(1, j), gap(1, j + 1)},
                                    {shape.stride(2), w.inverse_width[2][at(k)], gap(2, k), gap(2, k + 1)},
                                    d == 0 ? 0 : inverse_spacing_[m][at(along)],
                                    d == 0 ? 0 : w.lower[m][at(along)],
                                    d == 0 ? 0 : w.upper[m][at(along)],
                                    shape.stride(1),
                                    shape.stride(2),
                                    w.first[0],
                                    cells_[0]};
                double* const out = acceleration[m].data() + start;
                if (d == 0)
                    excess_row<0>(out, row, g);
                else if (d == 1)
                    excess_row<1>(out, row, g);
                else
                    excess_row<2>(out, row, g);
            }
    }
}

}  // namespace grainsweep::flow
