#include "solver/flow/flow.hpp"

#include "solver/bytes.hpp"
#include "solver/flow/rows.hpp"
#include "solver/flow/vector_clones.hpp"

#include <stdexcept>
#include <utility>

namespace grainsweep::flow {
namespace {

// r = dt (3/2 C - 1/2 C' + D + r - grad p): r comes in as the acceleration by forces.
struct AssembleRow {
    double* right;
    const double* now;
    const double* before;
    const double* diffusion;
    const double* pressure;
    const double* inverse_spacing;  // along x; nullptr: `gradient_scale` instead
    double gradient_scale;
    std::ptrdiff_t stride;
    int first, last;
    double now_weight, before_weight, time_step;
};

GRAINSWEEP_VECTOR_CLONES
void assemble_row(const AssembleRow& row) {
    double* __restrict right = row.right;
    const double* __restrict now = row.now;
    const double* __restrict before = row.before;
    const double* __restrict diffusion = row.diffusion;
    const double* __restrict p = row.pressure;
    const std::ptrdiff_t s = row.stride;
    const int last = row.last;
    if (row.inverse_spacing != nullptr) {
        const double* __restrict scale = row.inverse_spacing;
        for (int i = row.first; i <= last; ++i)
            right[i] = row.time_step * (row.now_weight * now[i] + row.before_weight * before[i] + diffusion[i] +
                                        right[i] - (p[i] - p[i - 1]) * scale[i]);
    } else {
        for (int i = row.first; i <= last; ++i)
            right[i] = row.time_step * (row.now_weight * now[i] + row.before_weight * before[i] + diffusion[i] +
                                        right[i] - (p[i] - p[i - s]) * row.gradient_scale);
    }
}

// to -= scale * difference of the potential.
GRAINSWEEP_VECTOR_CLONES
void correct_row(double* __restrict to, const double* __restrict q, std::ptrdiff_t s, const double* __restrict scale_x,
                 double scale, int first, int last) {
    if (scale_x != nullptr) {
        for (int i = first; i <= last; ++i) to[i] -= scale * scale_x[i] * (q[i] - q[i - 1]);
    } else {
        for (int i = first; i <= last; ++i) to[i] -= scale * (q[i] - q[i - s]);
    }
}

GRAINSWEEP_VECTOR_CLONES
void add_row(double* __restrict to, const double* __restrict a, const double* __restrict b, int first, int last) {
    for (int i = first; i <= last; ++i) to[i] = a[i] + b[i];
}

GRAINSWEEP_VECTOR_CLONES
void midpoint_values(std::size_t size, const double* __restrict now, const double* __restrict previous,
                     const double* __restrict c, const double* __restrict c_before, double inverse_step,
                     double c_weight, double c_before_weight, double* __restrict velocity,
                     double* __restrict acceleration) {
    for (std::size_t m = 0; m < size; ++m) {
        velocity[m] = 0.5 * (previous[m] + now[m]);
        acceleration[m] = (now[m] - previous[m]) * inverse_step - (c_weight * c[m] + c_before_weight * c_before[m]);
    }
}

void check(const FlowSetup& setup) {
    if (!(setup.time_step > 0)) throw std::invalid_argument("the time step of the flow must be positive");
    if (!(setup.viscosity >= 0)) throw std::invalid_argument("the viscosity of the flow must not be negative");
    for (int d = 0; d < 3; ++d) {
        const bool periodic = pressure_edges(setup.sides)[at(d)].periodic;
        if (periodic && !setup.grid[d].is_uniform())
            throw std::invalid_argument("a periodic axis must have equal cells");
        if (periodic && setup.grid.cells(d) == 2)
            throw std::invalid_argument("a periodic axis needs one cell or at least three");
    }
}

}  // namespace

template <class Heat>
Flow<Heat>::Flow(const FlowSetup& setup, const Heat& heat)
    : setup_((check(setup), setup)),
      cells_(cell_counts(setup.grid)),
      edges_{velocity_edges(setup.sides, 0), velocity_edges(setup.sides, 1), velocity_edges(setup.sides, 2)},
      pressure_edges_(pressure_edges(setup.sides)),
      weights_{Weights(setup.grid, edges_[0]), Weights(setup.grid, edges_[1]), Weights(setup.grid, edges_[2])},
      cell_weights_(setup.grid, pressure_edges_),
      poisson_(setup.grid, setup.sides),
      heat_(setup.grid, setup.sides, setup.time_step, heat),
      velocity_(face_vectors(setup.grid)),
      previous_(face_vectors(setup.grid)),
      convection_{face_vectors(setup.grid), face_vectors(setup.grid)},
      pressure_(setup.grid),
      increment_(setup.grid),
      right_(setup.grid),
      change_(setup.grid) {
    for (int d = 0; d < 3; ++d) {
        diffusion_.emplace_back(setup.grid, edges_[at(d)], 0.5 * setup.time_step * setup.viscosity);
        inverse_spacing_[at(d)].push_back(0);
        for (int f = 1; f <= cells_[at(d)] + 1; ++f) inverse_spacing_[at(d)].push_back(1 / setup.grid[d].spacing(f));
        fill_ghosts(velocity_[at(d)], setup_.grid, edges_[at(d)]);
    }
}

template <class Heat>
void Flow<Heat>::set_velocity(const VectorFunction& velocity) {
    const Grid& grid = setup_.grid;
    for (int d = 0; d < 3; ++d) {
        const auto place = [&](int axis, int i) { return axis == d ? grid[axis].face(i) : grid[axis].centre(i); };
        for (int k = 1; k <= cells_[2]; ++k)
            for (int j = 1; j <= cells_[1]; ++j)
                for (int i = 1; i <= cells_[0]; ++i)
                    velocity_[at(d)](i, j, k) = velocity(place(0, i), place(1, j), place(2, k))[at(d)];
        fill_ghosts(velocity_[at(d)], grid, edges_[at(d)]);
    }
}

template <class Heat>
void Flow<Heat>::step() {
    advance(nullptr, nullptr);
}

template <class Heat>
void Flow<Heat>::step(const FaceVectors& acceleration) {
    advance(&acceleration, nullptr);
}

template <class Heat>
void Flow<Heat>::step(const FaceVectors& acceleration, const Field& occupied) {
    advance(&acceleration, &occupied);
}

// right_ = dt (convection + diffusion + forces - grad p) for component d; leaves C^n in convection_[0].
template <class Heat>
void Flow<Heat>::assemble(int d, const FaceVectors* acceleration, const Field* occupied, const Planes& planes) {
    const auto m = at(d);
    Field& now = convection_[0][m];
    momentum_transport(d, velocity_, weights_[m], cells_, setup_.viscosity, now, change_, planes);
    const auto& first = weights_[m].first;
    if (acceleration != nullptr)
        set_planes(right_, planes, [given = (*acceleration)[m].data()](std::ptrdiff_t place) { return given[place]; });
    else
        set_planes(right_, planes, [](std::ptrdiff_t) { return 0.0; });
    const double middle = time() + 0.5 * setup_.time_step;
    heat_.add_force(d, middle, right_, planes);
    if (occupied != nullptr) heat_.remove_force(d, middle, *occupied, right_, planes);
    const auto [now_weight, before_weight] = convection_weights(steps_ == 0);
    each_row(right_, first, cells_, planes, [&, nw = now_weight, bw = before_weight](std::ptrdiff_t row, int j, int k) {
        assemble_row({right_.data() + row, now.data() + row, convection_[1][m].data() + row, change_.data() + row,
                      pressure_.data() + row, d == 0 ? inverse_spacing_[0].data() : nullptr,
                      d == 0 ? 0.0 : inverse_spacing_[m][at(d == 1 ? j : k)], right_.stride(d), first[0], cells_[0], nw,
                      bw, setup_.time_step});
    });
}

// Velocity -> its divergence-free part; leaves the potential in increment_ (ghosts filled) and div in divergence_.
template <class Heat>
void Flow<Heat>::project() {
    const double dt = setup_.time_step;
    divergence_.resize(setup_.grid.total_cells());
    potential_.resize(divergence_.size());
    each_slab(slabs_, cells_, [&](const Planes& planes) {
        divergence(velocity_, cell_weights_, cells_, divergence_, planes);
        each_row(increment_, {1, 1, 1}, cells_, planes, [&](std::ptrdiff_t, int j, int k) {
            const auto start = compact_row(cells_, j, k);
            for (auto m = start; m < start + cells_[0]; ++m)
                potential_[static_cast<std::size_t>(m)] = divergence_[static_cast<std::size_t>(m)] / dt;
        });
    });
    poisson_.solve(potential_, slabs_);
    each_slab(slabs_, cells_, [&](const Planes& planes) {
        each_row(increment_, {1, 1, 1}, cells_, planes, [&](std::ptrdiff_t row, int j, int k) {
            std::copy_n(potential_.data() + compact_row(cells_, j, k), cells_[0], increment_.data() + row + 1);
        });
    });
    fill_ghosts(increment_, setup_.grid, pressure_edges_, slabs_);
    each_slab(slabs_, cells_, [&](const Planes& planes) {
        for (int d = 0; d < 3; ++d) {
            Field& v = velocity_[at(d)];
            const auto& first = weights_[at(d)].first;
            each_row(v, first, cells_, planes, [&](std::ptrdiff_t row, int j, int k) {
                const double scale = d == 0 ? dt : dt * inverse_spacing_[at(d)][at(d == 1 ? j : k)];
                correct_row(v.data() + row, increment_.data() + row, v.stride(d),
                            d == 0 ? inverse_spacing_[0].data() : nullptr, scale, first[0], cells_[0]);
            });
        }
    });
    fill_ghosts(velocity_, setup_.grid, edges_, slabs_);
}

// Projects the initial velocity and finds the pressure of the initial state: lap p = div(C + nu lap V + buoyancy).
template <class Heat>
void Flow<Heat>::start() {
    project();
    heat_.start();
    const FaceVectors initial = velocity_;
    std::fill(pressure_.values().begin(), pressure_.values().end(), 0.0);
    FaceVectors rate = face_vectors(setup_.grid);
    for (int d = 0; d < 3; ++d) {
        const auto m = at(d);
        momentum_transport(d, initial, weights_[m], cells_, setup_.viscosity, convection_[0][m], change_);
        heat_.add_force(d, 0, rate[m], {});
        const auto& first = weights_[m].first;
        each_row(right_, first, cells_, {}, [&](std::ptrdiff_t row, int, int) {
            for (int i = first[0]; i <= cells_[0]; ++i)
                rate[m].data()[row + i] += convection_[0][m].data()[row + i] + change_.data()[row + i];
        });
        velocity_[m] = rate[m];
        fill_ghosts(velocity_[m], setup_.grid, edges_[m]);
    }
    // fill_ghosts moved sliding walls into the ghosts only; the divergence sees faces alone.
    project();
    pressure_ = increment_;
    for (double& p : pressure_.values()) p *= setup_.time_step;
    velocity_ = initial;
}

template <class Heat>
void Flow<Heat>::advance(const FaceVectors* acceleration, const Field* occupied) {
    if (steps_ == 0) start();
    heat_.step(velocity_, steps_ == 0, slabs_);
    std::swap(convection_[0], convection_[1]);
    for (int d = 0; d < 3; ++d) {
        const auto m = at(d);
        each_slab(slabs_, cells_, [&](const Planes& planes) { assemble(d, acceleration, occupied, planes); });
        diffusion_[m].solve(right_, change_, slabs_);
        const auto& first = weights_[m].first;
        each_slab(slabs_, cells_, [&](const Planes& planes) {
            each_row(right_, first, cells_, planes, [&](std::ptrdiff_t row, int, int) {
                add_row(previous_[m].data() + row, velocity_[m].data() + row, change_.data() + row, first[0],
                        cells_[0]);
            });
        });
    }
    std::swap(velocity_, previous_);
    fill_ghosts(velocity_, setup_.grid, edges_, slabs_);
    project();
    const double half_viscosity = 0.5 * setup_.viscosity;
    each_slab(slabs_, cells_, [&](const Planes& planes) {
        each_row(pressure_, {1, 1, 1}, cells_, planes, [&](std::ptrdiff_t row, int j, int k) {
            double* const p = pressure_.data() + row;
            const double* const q = increment_.data() + row;
            const double* const div = divergence_.data() + compact_row(cells_, j, k);
            for (int i = 1; i <= cells_[0]; ++i) p[i] += q[i] - half_viscosity * div[i - 1];
        });
    });
    fill_ghosts(pressure_, setup_.grid, pressure_edges_, slabs_);
    ++steps_;
}

template <class Heat>
void Flow<Heat>::midpoint(FaceVectors& velocity, FaceVectors& acceleration) const {
    const auto [now, before] = convection_weights(steps_ <= 1);
    // Beyond the walls the acceleration continues as the velocity does, from a wall that does not accelerate.
    auto still = edges_;
    for (Edges& edges : still)
        for (Edge& edge : edges)
            for (Ghost& ghost : edge.ghost) ghost.constant = 0;
    each_slab(slabs_, cells_, [&, w = now, w_before = before](const Planes& planes) {
        const Field& shape = velocity_[0];
        const auto start = shape.index(0, 0, planes.first);
        const auto size = static_cast<std::size_t>(shape.index(0, 0, planes.last + 1) - start);
        for (std::size_t d = 0; d < 3; ++d)
            midpoint_values(size, velocity_[d].data() + start, previous_[d].data() + start,
                            convection_[0][d].data() + start, convection_[1][d].data() + start, 1 / setup_.time_step, w,
                            w_before, velocity[d].data() + start, acceleration[d].data() + start);
    });
    fill_ghosts({{velocity[0], edges_[0]},
                 {velocity[1], edges_[1]},
                 {velocity[2], edges_[2]},
                 {acceleration[0], still[0]},
                 {acceleration[1], still[1]},
                 {acceleration[2], still[2]}},
                setup_.grid, slabs_);
}

template <class Heat>
double Flow<Heat>::largest_divergence() const {
    std::vector<double> values(setup_.grid.total_cells());
    divergence(velocity_, cell_weights_, cells_, values);
    double largest = 0;
    for (const double value : values) largest = std::max(largest, std::abs(value));
    return largest;
}

template <class Heat>
auto Flow<Heat>::fastest() const -> Fastest {
    Fastest found;
    const Grid& grid = setup_.grid;
    for (int d = 0; d < 3; ++d)
        for (int k = 1; k <= cells_[2]; ++k)
            for (int j = 1; j <= cells_[1]; ++j)
                for (int i = 1; i <= cells_[0]; ++i) {
                    const int along = d == 0 ? i : d == 1 ? j : k;
                    const double courant =
                        std::abs(velocity_[at(d)](i, j, k)) * setup_.time_step / grid[d].width(along);
                    if (courant <= found.courant) continue;
                    found = {courant, d, {grid[0].centre(i), grid[1].centre(j), grid[2].centre(k)}};
                    found.position[at(d)] = grid[d].face(along);
                    if (!std::isfinite(courant)) return found;
                }
    return found;
}

template <class Heat>
void Flow<Heat>::save(std::vector<std::byte>& into) const {
    append_bytes(into, steps_);
    for (std::size_t d = 0; d < 3; ++d) {
        append_bytes<double>(into, velocity_[d].values());
        append_bytes<double>(into, convection_[0][d].values());
    }
    append_bytes<double>(into, pressure_.values());
    heat_.save(into);
}

template <class Heat>
void Flow<Heat>::restore(std::span<const std::byte>& from) {
    take_bytes(from, steps_);
    for (std::size_t d = 0; d < 3; ++d) {
        take_bytes<double>(from, velocity_[d].values());
        take_bytes<double>(from, convection_[0][d].values());
    }
    take_bytes<double>(from, pressure_.values());
    heat_.restore(from);
    require_possible(steps_ >= 0 && steps_ < std::int64_t{1} << 53U);
}

template class Flow<NoHeat>;
template class Flow<Boussinesq>;

}  // namespace grainsweep::flow
