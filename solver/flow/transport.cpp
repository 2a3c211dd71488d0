#include "solver/flow/transport.hpp"

#include "solver/flow/rows.hpp"
#include "solver/flow/vector_clones.hpp"

namespace grainsweep::flow {
namespace {

// A row of constant weights along y and z, a vector of them along x.
struct RowWeights {
    const double* low_x;
    const double* high_x;
    const double* inverse_width_x;
    const double* lower_x;
    const double* upper_x;
    double low_y, high_y, inverse_width_y, low_z, high_z, inverse_width_z;
    double lower, upper;  // of the component's own axis when that is y or z
};

RowWeights row_weights(const Weights& w, int d, int j, int k) {
    const double lower = d == 1 ? w.lower[1][at(j)] : d == 2 ? w.lower[2][at(k)] : 0;
    const double upper = d == 1 ? w.upper[1][at(j)] : d == 2 ? w.upper[2][at(k)] : 0;
    return {w.low[0].data(),
            w.high[0].data(),
            w.inverse_width[0].data(),
            w.lower[0].data(),
            w.upper[0].data(),
            w.low[1][at(j)],
            w.high[1][at(j)],
            w.inverse_width[1][at(j)],
            w.low[2][at(k)],
            w.high[2][at(k)],
            w.inverse_width[2][at(k)],
            lower,
            upper};
}

struct MomentumRow {
    const double* own;               // v_d at i = 0
    std::array<const double*, 3> q;  // all components at i = 0
    std::ptrdiff_t sy, sz;
    int first, last;
    double viscosity;
};

// All inputs of a row's loop by value, and its outputs as restricted parameters. Through a reference, a weight would be
// loaded again after every store, and the loop could not be vectorised.
struct Across {
    std::ptrdiff_t step;
    double inverse_width, low, high;
};

// Convection (outflow) and spread of the own value in direction E at place i, for component D.
template <int D, int E>
[[gnu::always_inline]] inline void add_direction(const double* own, const double* q, std::ptrdiff_t s, std::ptrdiff_t i,
                                                 double lower, double upper, const Across& e, double& out,
                                                 double& spread) {
    const double centre = own[i];
    const double before = own[i - e.step];
    const double after = own[i + e.step];
    double flux_in = 0.5 * (before + centre);
    double flux_out = 0.5 * (centre + after);
    // Advecting velocity times the average advected value: own direction at cell centres, others at edges.
    if constexpr (D == E) {
        flux_in *= flux_in;
        flux_out *= flux_out;
    } else {
        flux_in *= lower * q[i - s] + upper * q[i];
        flux_out *= lower * q[i - s + e.step] + upper * q[i + e.step];
    }
    out += (flux_out - flux_in) * e.inverse_width;
    spread += e.low * (before - centre) + e.high * (after - centre);
}

template <int D>
GRAINSWEEP_VECTOR_CLONES void momentum_row(double* __restrict convection, double* __restrict diffusion,
                                           const MomentumRow& row, const RowWeights& w) {
    const double* own = row.own;
    const double* u = row.q[0];
    const double* v = row.q[1];
    const double* z = row.q[2];
    const double* low_x = w.low_x;
    const double* high_x = w.high_x;
    const double* inverse_width_x = w.inverse_width_x;
    const double* lower_x = w.lower_x;
    const double* upper_x = w.upper_x;
    const Across y{row.sy, w.inverse_width_y, w.low_y, w.high_y};
    const Across up{row.sz, w.inverse_width_z, w.low_z, w.high_z};
    const double lower_d = w.lower;
    const double upper_d = w.upper;
    const double viscosity = row.viscosity;
    const std::ptrdiff_t s = D == 0 ? 1 : D == 1 ? row.sy : row.sz;
    const int last = row.last;
    for (int i = row.first; i <= last; ++i) {
        const double lower = D == 0 ? lower_x[i] : lower_d;
        const double upper = D == 0 ? upper_x[i] : upper_d;
        double out = 0;
        double spread = 0;
        add_direction<D, 0>(own, u, s, i, lower, upper, {1, inverse_width_x[i], low_x[i], high_x[i]}, out, spread);
        add_direction<D, 1>(own, v, s, i, lower, upper, y, out, spread);
        add_direction<D, 2>(own, z, s, i, lower, upper, up, out, spread);
        convection[i] = -out;
        diffusion[i] = viscosity * spread;
    }
}

struct ScalarRow {
    const double* scalar;
    std::array<const double*, 3> q;
    std::ptrdiff_t sy, sz;
    int last;
    double diffusivity;
};

GRAINSWEEP_VECTOR_CLONES
void scalar_row(double* __restrict convection, double* __restrict diffusion, const ScalarRow& row,
                const RowWeights& w) {
    const double* __restrict a = row.scalar;
    const double* __restrict u = row.q[0];
    const double* __restrict v = row.q[1];
    const double* __restrict z = row.q[2];
    const std::ptrdiff_t sy = row.sy;
    const std::ptrdiff_t sz = row.sz;
    for (int i = 1; i <= row.last; ++i) {
        const double c = a[i];
        const double out = (u[i + 1] * (c + a[i + 1]) - u[i] * (a[i - 1] + c)) * w.inverse_width_x[i] +
                           (v[i + sy] * (c + a[i + sy]) - v[i] * (a[i - sy] + c)) * w.inverse_width_y +
                           (z[i + sz] * (c + a[i + sz]) - z[i] * (a[i - sz] + c)) * w.inverse_width_z;
        convection[i] = -0.5 * out;
        diffusion[i] =
            row.diffusivity * (w.low_x[i] * (a[i - 1] - c) + w.high_x[i] * (a[i + 1] - c) + w.low_y * (a[i - sy] - c) +
                               w.high_y * (a[i + sy] - c) + w.low_z * (a[i - sz] - c) + w.high_z * (a[i + sz] - c));
    }
}

GRAINSWEEP_VECTOR_CLONES
void divergence_row(const std::array<const double*, 3>& q, std::ptrdiff_t sy, std::ptrdiff_t sz, const RowWeights& w,
                    int last, double* __restrict result) {
    const double* __restrict u = q[0];
    const double* __restrict v = q[1];
    const double* __restrict z = q[2];
    for (int i = 1; i <= last; ++i)
        result[i - 1] = (u[i + 1] - u[i]) * w.inverse_width_x[i] + (v[i + sy] - v[i]) * w.inverse_width_y +
                        (z[i + sz] - z[i]) * w.inverse_width_z;
}

std::array<const double*, 3> rows_at(const FaceVectors& velocity, std::ptrdiff_t start) {
    return {velocity[0].data() + start, velocity[1].data() + start, velocity[2].data() + start};
}

}  // namespace

Weights::Weights(const Grid& grid, const Edges& edges) {
    for (int d = 0; d < 3; ++d) {
        const auto m = static_cast<std::size_t>(d);
        const Axis& axis = grid[d];
        const SecondDifference difference(axis, edges[m]);
        low[m] = difference.low;
        high[m] = difference.high;
        first[m] = first_unknown(edges[m]);
        const auto size = static_cast<std::size_t>(axis.cells()) + 2;
        inverse_width[m].assign(size, 0);
        lower[m].assign(size, 0);
        upper[m].assign(size, 0);
        for (int i = 1; i <= axis.cells(); ++i) {
            const double below = axis.width(i - 1);
            const double above = axis.width(i);
            inverse_width[m][at(i)] = 1 / (edges[m].on_faces ? axis.spacing(i) : above);
            lower[m][at(i)] = below / (below + above);
            upper[m][at(i)] = above / (below + above);
        }
    }
}

void momentum_transport(int d, const FaceVectors& velocity, const Weights& weights, const std::array<int, 3>& cells,
                        double viscosity, Field& convection, Field& diffusion, const Planes& planes) {
    const Field& own = velocity[static_cast<std::size_t>(d)];
    const auto kernel = d == 0 ? momentum_row<0> : d == 1 ? momentum_row<1> : momentum_row<2>;
    each_row(own, weights.first, cells, planes, [&](std::ptrdiff_t start, int j, int k) {
        kernel(convection.data() + start, diffusion.data() + start,
               {own.data() + start, rows_at(velocity, start), own.stride(1), own.stride(2), weights.first[0], cells[0],
                viscosity},
               row_weights(weights, d, j, k));
    });
}

void scalar_transport(const FaceVectors& velocity, const Field& scalar, const Weights& weights,
                      const std::array<int, 3>& cells, double diffusivity, Field& convection, Field& diffusion,
                      const Planes& planes) {
    each_row(scalar, {1, 1, 1}, cells, planes, [&](std::ptrdiff_t start, int j, int k) {
        scalar_row(convection.data() + start, diffusion.data() + start,
                   {scalar.data() + start, rows_at(velocity, start), scalar.stride(1), scalar.stride(2), cells[0],
                    diffusivity},
                   row_weights(weights, 0, j, k));
    });
}

void divergence(const FaceVectors& velocity, const Weights& cell_weights, const std::array<int, 3>& cells,
                std::vector<double>& result, const Planes& planes) {
    const Field& shape = velocity[0];
    each_row(shape, {1, 1, 1}, cells, planes, [&](std::ptrdiff_t start, int j, int k) {
        divergence_row(rows_at(velocity, start), shape.stride(1), shape.stride(2), row_weights(cell_weights, 0, j, k),
                       cells[0], result.data() + compact_row(cells, j, k));
    });
}

}  // namespace grainsweep::flow
