#include "solver/coupling/interpolation.hpp"

namespace grainsweep::coupling {
namespace {

// Lines along axis d, those with places from ... to on the outer one of the other axes.
template <class Body>
void each_line(const flow::Field& field, const flow::Grid& grid, int d, std::ptrdiff_t from, std::ptrdiff_t to,
               Body body) {
    const int a = d == 0 ? 1 : 0;
    const int b = d == 2 ? 1 : 2;
    for (std::ptrdiff_t q = from; q <= to; ++q)
        for (int p = 0; p <= grid.cells(a) + 1; ++p) body(p * field.stride(a) + q * field.stride(b));
}

void fold_along(flow::Field& field, const flow::Grid& grid, const flow::Edge& edge, int d, std::ptrdiff_t from,
                std::ptrdiff_t to) {
    const int n = grid.cells(d);
    const auto stride = field.stride(d);
    double* const values = field.data();
    each_line(field, grid, d, from, to, [&](std::ptrdiff_t line) {
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

}  // namespace

void fold_ghosts(flow::Field& field, const flow::Grid& grid, const flow::Edges& edges, const Slabs& slabs) {
    // The reverse of the order in which ghosts are filled; lines along x and y stay in one plane.
    slabs.over(0, grid.cells(1) + 1,
               [&](std::ptrdiff_t from, std::ptrdiff_t to) { fold_along(field, grid, edges[2], 2, from, to); });
    slabs.over(0, grid.cells(2) + 1, [&](std::ptrdiff_t from, std::ptrdiff_t to) {
        fold_along(field, grid, edges[1], 1, from, to);
        fold_along(field, grid, edges[0], 0, from, to);
    });
}

std::array<flow::Edges, 3> frictionless_edges(flow::Sides sides) {
    for (auto& axis : sides)
        for (flow::Side& side : axis)
            if (std::holds_alternative<flow::NoSlip>(side)) side = flow::FreeSlip{};
    return {flow::velocity_edges(sides, 0), flow::velocity_edges(sides, 1), flow::velocity_edges(sides, 2)};
}

std::array<bool, 3> periodic_axes(const flow::Sides& sides) {
    std::array<bool, 3> axes{};
    for (std::size_t d = 0; d < 3; ++d) axes[d] = std::holds_alternative<flow::Periodic>(sides[d][0]);
    return axes;
}

FaceDeposit::FaceDeposit(const flow::Grid& grid, const flow::Sides& sides, double width, Hats hats)
    : grid_(grid), edges_(frictionless_edges(sides)), scratch_{flow::Field(grid), flow::Field(grid)} {
    for (int d = 0; d < 3; ++d) {
        std::array<Nodes, 3> nodes{Nodes::cells, Nodes::cells, Nodes::cells};
        nodes[static_cast<std::size_t>(d)] = Nodes::faces;
        spreading_.emplace_back(grid, periodic_axes(sides), nodes, width, hats);
    }
}

void FaceDeposit::clear(flow::Field& field, const Slabs& slabs) {
    slabs.over(0, static_cast<std::ptrdiff_t>(field.size()) - 1, [&](std::ptrdiff_t first, std::ptrdiff_t last) {
        std::fill(field.data() + first, field.data() + last + 1, 0.0);
    });
}

void FaceDeposit::clear(flow::FaceVectors& faces, const Slabs& slabs) {
    for (auto& field : faces) clear(field, slabs);
}

void FaceDeposit::spread(flow::FaceVectors& faces) {
    for (std::size_t d = 0; d < 3; ++d) {
        fold_ghosts(faces[d], grid_, edges_[d], slabs_);
        spreading_[d].densities(faces[d], scratch_, slabs_);
    }
}

void FaceDeposit::spread_transposed(flow::FaceVectors& faces) {
    for (std::size_t d = 0; d < 3; ++d) spreading_[d].spread(faces[d], scratch_, slabs_);
    fill_ghosts(faces, grid_, edges_, slabs_);
}

}  // namespace grainsweep::coupling
