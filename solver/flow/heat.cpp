#include "solver/flow/heat.hpp"

#include "solver/bytes.hpp"
#include "solver/flow/rows.hpp"
#include "solver/flow/vector_clones.hpp"

#include <utility>

namespace grainsweep::flow {
namespace {

// out += strength (lower a[i - s] + (1 - lower) a[i])
GRAINSWEEP_VECTOR_CLONES
void add_interpolated_row(double* __restrict out, const double* __restrict a, std::ptrdiff_t s,
                          const double* __restrict lower_x, double lower, double strength, int first, int last) {
    if (lower_x != nullptr) {
        for (int i = first; i <= last; ++i) out[i] += strength * (lower_x[i] * a[i - 1] + (1 - lower_x[i]) * a[i]);
    } else {
        const double upper = 1 - lower;
        for (int i = first; i <= last; ++i) out[i] += strength * (lower * a[i - s] + upper * a[i]);
    }
}

}  // namespace

HeatState<Boussinesq>::HeatState(const Grid& grid, const Sides& sides, double time_step, const Boussinesq& heat)
    : cells_(cell_counts(grid)),
      time_step_(time_step),
      heat_(heat),
      edges_(temperature_edges(sides, heat.sides)),
      grid_(grid),
      weights_(grid, edges_),
      diffusion_(grid, edges_, 0.5 * time_step * heat.diffusivity),
      temperature_(grid),
      middle_(grid),
      convection_{Field(grid), Field(grid)},
      right_(grid),
      change_(grid) {
    for (int d = 0; d < 3; ++d)
        for (int f = 0; f <= cells_[at(d)] + 1; ++f) {
            const double below = f > 0 ? grid[d].width(f - 1) : 1;
            const double above = grid[d].width(f);
            face_lower_[at(d)].push_back(above / (below + above));
        }
    fill_ghosts(temperature_, grid, edges_);
}

void HeatState<Boussinesq>::set(const ScalarFunction& temperature) {
    for (int k = 1; k <= cells_[2]; ++k)
        for (int j = 1; j <= cells_[1]; ++j)
            for (int i = 1; i <= cells_[0]; ++i)
                temperature_(i, j, k) = temperature(grid_[0].centre(i), grid_[1].centre(j), grid_[2].centre(k));
    fill_ghosts(temperature_, grid_, edges_);
}

void HeatState<Boussinesq>::start() {
    middle_ = temperature_;
}

void HeatState<Boussinesq>::step(const FaceVectors& velocity, bool first, const Slabs& slabs) {
    std::swap(convection_[0], convection_[1]);
    const auto [now, before] = convection_weights(first);
    const double dt = time_step_;
    each_slab(slabs, cells_, [&, w = now, w_before = before](const Planes& planes) {
        scalar_transport(velocity, temperature_, weights_, cells_, heat_.diffusivity, convection_[0], right_, planes);
        each_row(right_, {1, 1, 1}, cells_, planes, [&](std::ptrdiff_t row, int, int) {
            double* const r = right_.data() + row;
            const double* const c = convection_[0].data() + row;
            const double* const old = convection_[1].data() + row;
            for (int i = 1; i <= cells_[0]; ++i) r[i] = dt * (w * c[i] + w_before * old[i] + r[i]);
        });
    });
    diffusion_.solve(right_, change_, slabs);
    each_slab(slabs, cells_, [&](const Planes& planes) {
        each_row(right_, {1, 1, 1}, cells_, planes, [&](std::ptrdiff_t row, int, int) {
            double* const theta = temperature_.data() + row;
            double* const middle = middle_.data() + row;
            const double* const change = change_.data() + row;
            for (int i = 1; i <= cells_[0]; ++i) {
                middle[i] = theta[i] + 0.5 * change[i];
                theta[i] += change[i];
            }
        });
    });
    fill_ghosts({{temperature_, edges_}, {middle_, edges_}}, grid_, slabs);
}

void HeatState<Boussinesq>::add_force(int d, double time, Field& acceleration, const Planes& planes) const {
    if (d != heat_.direction) return;
    const double strength = heat_.buoyancy * heat_.vibration.at(time);
    const auto& lower = face_lower_[at(d)];
    each_row(acceleration, {1, 1, 1}, cells_, planes, [&](std::ptrdiff_t row, int j, int k) {
        add_interpolated_row(acceleration.data() + row, middle_.data() + row, middle_.stride(d),
                             d == 0 ? lower.data() : nullptr, d == 1 ? lower[at(j)] : lower[at(k)], strength, 1,
                             cells_[0]);
    });
}

void HeatState<Boussinesq>::remove_force(int d, double time, const Field& occupied, Field& acceleration,
                                         const Planes& planes) const {
    if (d != heat_.direction) return;
    const double strength = heat_.buoyancy * heat_.vibration.at(time);
    const auto& lower = face_lower_[at(d)];
    const auto s = acceleration.stride(d);
    each_row(acceleration, {1, 1, 1}, cells_, planes, [&](std::ptrdiff_t row, int j, int k) {
        const double* const share = occupied.data() + row;
        const double* const theta = middle_.data() + row;
        double* const a = acceleration.data() + row;
        for (int i = 1; i <= cells_[0]; ++i) {
            const double low = lower[at(d == 0 ? i : d == 1 ? j : k)];
            const double high = 1 - low;
            a[i] -= strength * (low * share[i - s] + high * share[i]) * (low * theta[i - s] + high * theta[i]);
        }
    });
}

void HeatState<Boussinesq>::save(std::vector<std::byte>& into) const {
    append_bytes<double>(into, temperature_.values());
    append_bytes<double>(into, convection_[0].values());
}

void HeatState<Boussinesq>::restore(std::span<const std::byte>& from) {
    take_bytes<double>(from, temperature_.values());
    take_bytes<double>(from, convection_[0].values());
}

}  // namespace grainsweep::flow
