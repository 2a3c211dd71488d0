#include "solver/coupling/interpolation.hpp"

#include <algorithm>
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

std::array<flow::Edges, 3> frictionless_edges(flow::Sides sides) {
    for (auto& axis : sides)
        for (flow::Side& side : axis)
            if (std::holds_alternative<flow::NoSlip>(side)) side = flow::FreeSlip{};
    return {flow::velocity_edges(sides, 0), flow::velocity_edges(sides, 1), flow::velocity_edges(sides, 2)};
}

void smooth(flow::Field& field, const flow::Grid& grid, const flow::Edges& edges, int passes, AtWalls at_walls) {
    // Row by row; along x a copy of the row is read, else a line of rows is swept with the old values of the row before
    // kept aside: no value waits for the one before it.
    const auto length = static_cast<std::size_t>(grid.cells(0)) + 2;
    std::vector<double> before(length);
    std::vector<double> beyond(length);
    for (int pass = 0; pass < passes; ++pass) {
        for (int d = 0; d < 3; ++d) {
            const flow::Edge& edge = edges[static_cast<std::size_t>(d)];
            const int first = flow::first_unknown(edge);
            const int n = grid.cells(d);
            if (n - first < 1) continue;
            const auto stride = field.stride(d);
            const int beyond_wall = edge.on_faces && at_walls == AtWalls::taken ? 1 : 0;
            const int low_end = edge.periodic ? n : first - beyond_wall;
            const int high_end = edge.periodic ? first : n + beyond_wall;
            if (d == 0) {
                each_line(field, grid, 0, [&](std::ptrdiff_t line) {
                    double* const v = field.data() + line;
                    const double* const old = before.data();
                    std::copy_n(v, length, before.begin());
                    before[static_cast<std::size_t>(first - 1)] = v[low_end];
                    before[static_cast<std::size_t>(n + 1)] = v[high_end];
                    for (int m = first; m <= n; ++m) v[m] = 0.25 * (old[m - 1] + old[m + 1]) + 0.5 * old[m];
                });
                continue;
            }
            const int across = d == 1 ? 2 : 1;
            for (int q = 0; q <= grid.cells(across) + 1; ++q) {
                double* const line = field.data() + q * field.stride(across);
                std::copy_n(line + low_end * stride, length, before.begin());
                std::copy_n(line + high_end * stride, length, beyond.begin());
                for (int m = first; m <= n; ++m) {
                    double* const row = line + m * stride;
                    const double* const after = m < n ? row + stride : beyond.data();
                    for (std::size_t i = 0; i < length; ++i) {
                        const double here = row[i];
                        row[i] = 0.25 * (before[i] + after[i]) + 0.5 * here;
                        before[i] = here;
                    }
                }
            }
        }
    }
}

FaceDeposit::FaceDeposit(const flow::Grid& grid, const flow::Sides& sides, int passes) : grid_(grid), passes_(passes) {
    for (int d = 0; d < 3; ++d) {
        edges_.push_back(flow::velocity_edges(sides, d));
        weights_.emplace_back(grid, edges_.back());
    }
}

void FaceDeposit::clear(flow::FaceVectors& faces) {
    for (auto& field : faces) std::fill(field.values().begin(), field.values().end(), 0.0);
}

void FaceDeposit::spread(flow::FaceVectors& faces) const {
    for (std::size_t d = 0; d < 3; ++d) {
        flow::Field& field = faces[d];
        fold_ghosts(field, grid_, edges_[d]);
        smooth(field, grid_, edges_[d], passes_);
        const auto& width = weights_[d].inverse_width;
        for (int k = 1; k <= grid_.cells(2); ++k)
            for (int j = 1; j <= grid_.cells(1); ++j) {
                const double yz = width[1][static_cast<std::size_t>(j)] * width[2][static_cast<std::size_t>(k)];
                double* const row = field.data() + field.index(0, j, k);
                for (int i = 1; i <= grid_.cells(0); ++i) row[i] *= yz * width[0][static_cast<std::size_t>(i)];
            }
    }
}

void FaceDeposit::smooth_transposed(flow::FaceVectors& faces) const {
    for (std::size_t d = 0; d < 3; ++d) {
        smooth(faces[d], grid_, edges_[d], passes_);
        flow::Edges edges = edges_[d];
        for (flow::Edge& edge : edges)
            for (flow::Ghost& ghost : edge.ghost) ghost.constant = 0;
        fill_ghosts(faces[d], grid_, edges);
    }
}

}  // namespace grainsweep::coupling
