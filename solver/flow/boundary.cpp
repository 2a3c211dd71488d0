#include "solver/flow/boundary.hpp"

#include <stdexcept>

namespace grainsweep::flow {
namespace {

bool periodic_axis(const Sides& sides, std::size_t d) {
    const bool low = std::holds_alternative<Periodic>(sides[d][0]);
    const bool high = std::holds_alternative<Periodic>(sides[d][1]);
    if (low != high) throw std::invalid_argument("an axis is periodic at both sides or at none");
    return low;
}

// Visits every line along axis d: body(index of its entry 0).
template <class Body>
void each_line(const Field& field, const Grid& grid, int d, Body body) {
    const int a = d == 0 ? 1 : 0;
    const int b = d == 2 ? 1 : 2;
    for (int q = 0; q <= grid.cells(b) + 1; ++q)
        for (int p = 0; p <= grid.cells(a) + 1; ++p) body(p * field.stride(a) + q * field.stride(b));
}

}  // namespace

Edges velocity_edges(const Sides& sides, int component) {
    Edges edges;
    const auto c = static_cast<std::size_t>(component);
    for (std::size_t d = 0; d < 3; ++d) {
        edges[d].periodic = periodic_axis(sides, d);
        edges[d].on_faces = d == c;
        for (std::size_t s = 0; s < 2; ++s)
            if (const auto* wall = std::get_if<NoSlip>(&sides[d][s])) edges[d].ghost[s] = {-1, 2 * wall->velocity[c]};
    }
    return edges;
}

Edges temperature_edges(const Sides& sides, const ThermalSides& thermal) {
    Edges edges;
    for (std::size_t d = 0; d < 3; ++d) {
        edges[d].periodic = periodic_axis(sides, d);
        for (std::size_t s = 0; s < 2; ++s)
            if (const auto* wall = std::get_if<Isothermal>(&thermal[d][s]))
                edges[d].ghost[s] = {-1, 2 * wall->temperature};
    }
    return edges;
}

Edges pressure_edges(const Sides& sides) {
    Edges edges;
    for (std::size_t d = 0; d < 3; ++d) edges[d].periodic = periodic_axis(sides, d);
    return edges;
}

void fill_ghosts(Field& field, const Grid& grid, const Edges& edges) {
    for (int d = 0; d < 3; ++d) {
        const Edge& edge = edges[static_cast<std::size_t>(d)];
        const int n = grid.cells(d);
        const auto stride = field.stride(d);
        double* const values = field.data();
        const auto high = (n + 1) * stride;
        if (edge.periodic) {
            each_line(field, grid, d, [=](std::ptrdiff_t line) {
                values[line] = values[line + n * stride];
                values[line + high] = values[line + stride];
            });
        } else if (edge.on_faces) {
            // Face 0 lies outside the box: the odd image of face 2 keeps the normal velocity smooth there.
            each_line(field, grid, d, [=](std::ptrdiff_t line) {
                values[line + stride] = 0;
                values[line + high] = 0;
                values[line] = -values[line + 2 * stride];
            });
        } else {
            const auto [low_ghost, high_ghost] = edge.ghost;
            each_line(field, grid, d, [=](std::ptrdiff_t line) {
                values[line] = low_ghost.sign * values[line + stride] + low_ghost.constant;
                values[line + high] = high_ghost.sign * values[line + n * stride] + high_ghost.constant;
            });
        }
    }
}

}  // namespace grainsweep::flow
