#include "solver/coupling/solids_volume.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace grainsweep::coupling {
namespace {

std::size_t at(int i) {
    return static_cast<std::size_t>(i);
}

template <class Body>
void each_cell(const flow::Grid& grid, Body body) {
    for (int k = 1; k <= grid.cells(2); ++k)
        for (int j = 1; j <= grid.cells(1); ++j)
            for (int i = 1; i <= grid.cells(0); ++i) body(i, j, k);
}

}  // namespace

double lone_fraction(const flow::Grid& grid, double particle_volume, double kernel_width) {
    const double box = grid[0].length() * grid[1].length() * grid[2].length();
    const double cell = std::cbrt(box / static_cast<double>(grid.total_cells()));
    const double variance = std::max(kernel_width * kernel_width, cell * cell / 6);
    return std::max(particle_volume / std::pow(2 * std::numbers::pi * variance, 1.5), particle_volume / box);
}

SolidsVolume::SolidsVolume(const flow::Grid& grid, const flow::Sides& sides, double particle_volume,
                           double kernel_width)
    : grid_(grid),
      edges_(flow::pressure_edges(sides)),
      particle_volume_(particle_volume),
      over_cells_(grid, periodic_axes(sides), {Nodes::cells, Nodes::cells, Nodes::cells}, kernel_width),
      scratch_{flow::Field(grid), flow::Field(grid)},
      fraction_(grid),
      flux_(flow::face_vectors(grid)) {
    for (std::size_t d = 0; d < 3; ++d) {
        std::array<Nodes, 3> nodes{Nodes::cells, Nodes::cells, Nodes::cells};
        nodes[d] = Nodes::flux;
        over_faces_.emplace_back(grid, periodic_axes(sides), nodes, kernel_width);
    }
}

int SolidsVolume::inside(int d, int cell) const {
    const int n = grid_.cells(d);
    if (cell >= 1 && cell <= n) return cell;
    return edges_[at(d)].periodic ? (cell - 1 + 4 * n) % n + 1 : std::clamp(cell, 1, n);
}

void SolidsVolume::start(std::span<const Vec3> positions) {
    place(positions);
    placed_before_ = placed_;
}

void SolidsVolume::place(std::span<const Vec3> positions) {
    placed_.position.assign(positions.begin(), positions.end());
    placed_.weights.clear();
    std::fill(fraction_.values().begin(), fraction_.values().end(), 0.0);
    for (const Vec3& x : positions) {
        std::array<AxisWeights<2>, 3>& w = placed_.weights.emplace_back();
        std::array<std::array<std::ptrdiff_t, 2>, 3> cell{};  // offsets
        for (int d = 0; d < 3; ++d) {
            const double along = x[at(d)];
            w[at(d)] = Trilinear::across(grid_[d], edges_[at(d)].periodic, along, Trilinear::find(grid_[d], along));
            for (int a = 0; a < 2; ++a) cell[at(d)][at(a)] = inside(d, w[at(d)].first + a) * fraction_.stride(d);
        }
        double* const fraction = fraction_.data();
        for (std::size_t c = 0; c < 2; ++c)
            for (std::size_t b = 0; b < 2; ++b)
                for (std::size_t a = 0; a < 2; ++a)
                    fraction[cell[0][a] + cell[1][b] + cell[2][c]] +=
                        particle_volume_ * (w[2].weight[c] * w[1].weight[b] * w[0].weight[a]);
    }
    over_cells_.densities(fraction_, scratch_);
    fill_ghosts(fraction_, grid_, edges_);
}

void SolidsVolume::mean(std::span<const Vec3> property, std::array<flow::Field, 3>& into) {
    for (auto& field : into) std::fill(field.values().begin(), field.values().end(), 0.0);
    for (std::size_t p = 0; p < property.size(); ++p) {
        const std::array<AxisWeights<2>, 3>& w = placed_.weights[p];
        std::array<std::array<std::ptrdiff_t, 2>, 3> cell{};  // offsets
        for (int d = 0; d < 3; ++d)
            for (int a = 0; a < 2; ++a) cell[at(d)][at(a)] = inside(d, w[at(d)].first + a) * fraction_.stride(d);
        for (std::size_t c = 0; c < 2; ++c)
            for (std::size_t b = 0; b < 2; ++b)
                for (std::size_t a = 0; a < 2; ++a) {
                    const double share = particle_volume_ * (w[2].weight[c] * w[1].weight[b] * w[0].weight[a]);
                    const auto to = cell[0][a] + cell[1][b] + cell[2][c];
                    for (std::size_t d = 0; d < 3; ++d) into[d].data()[to] += share * property[p][d];
                }
    }
    for (auto& field : into) {
        over_cells_.densities(field, scratch_);
        each_cell(grid_, [&](int i, int j, int k) {
            const double phi = fraction_(i, j, k);
            double& value = field(i, j, k);
            value = phi > 0 ? value / phi : 0;
        });
        fill_ghosts(field, grid_, edges_);
    }
}

void SolidsVolume::fill(int d, std::size_t p, Shares& shares) const {
    const double before = placed_before_.position[p][at(d)];
    const double after = placed_.position[p][at(d)];
    const bool periodic = edges_[at(d)].periodic;
    int periods = 0;
    if (periodic) {  // the image of `after` nearest to `before`
        periods = static_cast<int>(std::round((before - after) / grid_[d].length()));
    }
    AxisWeights<2> from = placed_before_.weights[p][at(d)];
    AxisWeights<2> to = placed_.weights[p][at(d)];
    if (!periodic) {  // all of a share beyond a wall belongs to the cell at the wall
        const int n = grid_.cells(d);
        for (AxisWeights<2>* w : {&from, &to}) {
            if (w->first == 0) *w = {1, {1, 0}};
            if (w->first == n) *w = {n - 1, {0, 1}};
            if (w->first == 0) *w = {1, {1, 0}};  // n = 1
        }
    }
    to.first += periods * grid_.cells(d);
    shares.first = std::min(from.first, to.first);
    const int count = std::max(from.first, to.first) + 2 - shares.first;
    shares.before.assign(at(count), 0);
    shares.change.assign(at(count), 0);
    for (int a = 0; a < 2; ++a) {
        shares.before[at(from.first - shares.first + a)] += from.weight[at(a)];
        shares.change[at(from.first - shares.first + a)] -= from.weight[at(a)];
        shares.change[at(to.first - shares.first + a)] += to.weight[at(a)];
    }
}

// Net share that has passed the face below each cell, one after the other along D.
template <int D>
void SolidsVolume::carry_along(const std::array<Shares, 3>& shares, double scale) {
    constexpr int A = D == 0 ? 1 : 0;
    constexpr int B = D == 2 ? 1 : 2;
    const Shares& own = shares[D];
    if (own.before.size() == 2 && own.change[0] == 0) return;
    double* const flux = flux_[D].data();
    const auto stride = flux_[D].stride(D);
    for (std::size_t b = 0; b < shares[B].before.size(); ++b)
        for (std::size_t a = 0; a < shares[A].before.size(); ++a) {
            const double sa = shares[A].before[a];
            const double da = shares[A].change[a];
            const double sb = shares[B].before[b];
            const double db = shares[B].change[b];
            const double across = scale * (sa * sb + 0.5 * (da * sb + sa * db) + da * db / 3);
            const auto line = inside(A, shares[A].first + static_cast<int>(a)) * flux_[D].stride(A) +
                              inside(B, shares[B].first + static_cast<int>(b)) * flux_[D].stride(B);
            double passed = 0;
            for (std::size_t c = 0; c + 1 < own.before.size(); ++c) {
                passed -= own.change[c] * across;
                flux[line + inside(D, own.first + static_cast<int>(c) + 1) * stride] += passed;
            }
        }
}

void SolidsVolume::carry(double dt) {
    FaceDeposit::clear(flux_);
    std::array<Shares, 3> shares;
    for (std::size_t p = 0; p < placed_.position.size(); ++p) {
        for (int d = 0; d < 3; ++d) fill(d, p, shares[at(d)]);
        const double scale = particle_volume_ / dt;
        carry_along<0>(shares, scale);
        carry_along<1>(shares, scale);
        carry_along<2>(shares, scale);
    }
    placed_before_ = placed_;
    for (int d = 0; d < 3; ++d) over_faces_[at(d)].densities(flux_[at(d)], scratch_);
}

double SolidsVolume::largest_fraction() const {
    return *std::max_element(fraction_.values().begin(), fraction_.values().end());
}

}  // namespace grainsweep::coupling
