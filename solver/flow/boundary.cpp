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

// Visits lines along axis d, those with places from ... to on the outer one of the other axes: body(index of entry 0).
template <class Body>
void each_line(const Field& field, const Grid& grid, int d, std::ptrdiff_t from, std::ptrdiff_t to, Body body) {
    const int a = d == 0 ? 1 : 0;
    const int b = d == 2 ? 1 : 2;
    for (std::ptrdiff_t q = from; q <= to; ++q)
        for (int p = 0; p <= grid.cells(a) + 1; ++p) body(p * field.stride(a) + q * field.stride(b));
}

void fill_along(Field& field, const Grid& grid, const Edge& edge, int d, std::ptrdiff_t from, std::ptrdiff_t to) {
    const int n = grid.cells(d);
    const auto stride = field.stride(d);
    double* const values = field.data();
    const auto high = (n + 1) * stride;
    if (edge.periodic) {
        each_line(field, grid, d, from, to, [=](std::ptrdiff_t line) {
            values[line] = values[line + n * stride];
            values[line + high] = values[line + stride];
        });
    } else if (edge.on_faces) {
        // Face 0 lies outside the box: the odd image of face 2 keeps the normal velocity smooth there.
        each_line(field, grid, d, from, to, [=](std::ptrdiff_t line) {
            values[line + stride] = 0;
            values[line + high] = 0;
            values[line] = -values[line + 2 * stride];
        });
    } else {
        const auto [low_ghost, high_ghost] = edge.ghost;
        each_line(field, grid, d, from, to, [=](std::ptrdiff_t line) {
            values[line] = low_ghost.sign * values[line + stride] + low_ghost.constant;
            values[line + high] = high_ghost.sign * values[line + n * stride] + high_ghost.constant;
        });
    }
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

void fill_ghosts(std::initializer_list<Bordered> fields, const Grid& grid, const Slabs& slabs) {
    // Lines along x and y stay in one plane; those along z go through all.
    slabs.over(0, grid.cells(2) + 1, [&](std::ptrdiff_t from, std::ptrdiff_t to) {
        for (const auto& [field, edges] : fields)
            for (int d = 0; d < 2; ++d) fill_along(field, grid, edges[static_cast<std::size_t>(d)], d, from, to);
    });
    slabs.over(0, grid.cells(1) + 1, [&](std::ptrdiff_t from, std::ptrdiff_t to) {
        for (const auto& [field, edges] : fields) fill_along(field, grid, edges[2], 2, from, to);
    });
}

void fill_ghosts(Field& field, const Grid& grid, const Edges& edges, const Slabs& slabs) {
    fill_ghosts({{field, edges}}, grid, slabs);
}

void fill_ghosts(FaceVectors& faces, const Grid& grid, const std::array<Edges, 3>& edges, const Slabs& slabs) {
    fill_ghosts({{faces[0], edges[0]}, {faces[1], edges[1]}, {faces[2], edges[2]}}, grid, slabs);
}

}  // namespace grainsweep::flow
