#include "solver/coupling/solids_volume.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace grainsweep::coupling {
namespace {

std::size_t at(int i) {
    return static_cast<std::size_t>(i);
}

/// Sums over eight cells: their shares of a particle and places in the field, those in these planes.
template <class Body>
void each_share(const std::array<AxisWeights<2>, 3>& w, const std::array<std::array<std::ptrdiff_t, 2>, 3>& cell,
                const std::array<bool, 2>& in_planes, double volume, Body body) {
    for (std::size_t c = 0; c < 2; ++c) {
        if (!in_planes[c]) continue;
        for (std::size_t b = 0; b < 2; ++b)
            for (std::size_t a = 0; a < 2; ++a)
                body(cell[0][a] + cell[1][b] + cell[2][c], volume * (w[2].weight[c] * w[1].weight[b] * w[0].weight[a]));
    }
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

flow::Planes SolidsVolume::planes_of(const AxisWeights<2>& along_z) const {
    const int low = inside(2, along_z.first);
    const int high = inside(2, along_z.first + 1);
    return {std::min(low, high), std::max(low, high)};
}

// Which cells a particle lies in along each axis.
void SolidsVolume::locate(std::size_t p) {
    for (int d = 0; d < 3; ++d) {
        const double along = placed_.position[p][at(d)];
        placed_.weights[p][at(d)] =
            Trilinear::across(grid_[d], edges_[at(d)].periodic, along, Trilinear::find(grid_[d], along));
    }
}

template <class Body>
void SolidsVolume::deposit(Body body) {
    cuts_.make(placed_.weights.size(), grid_.cells(2) + 2, slabs_,
               [&](std::size_t p) { return planes_of(placed_.weights[p][2]); });
    cuts_.each(slabs_, [&](std::size_t p, const flow::Planes& own) {
        const std::array<AxisWeights<2>, 3>& w = placed_.weights[p];
        std::array<std::array<std::ptrdiff_t, 2>, 3> cell{};  // offsets
        std::array<bool, 2> in_planes{};
        for (int d = 0; d < 3; ++d)
            for (int a = 0; a < 2; ++a) {
                const int place = inside(d, w[at(d)].first + a);
                cell[at(d)][at(a)] = place * fraction_.stride(d);
                if (d == 2) in_planes[at(a)] = own.first <= place && place <= own.last;
            }
        each_share(w, cell, in_planes, particle_volume_, [&](std::ptrdiff_t to, double share) { body(p, to, share); });
    });
}

void SolidsVolume::place(std::span<const Vec3> positions) {
    placed_.position.resize(positions.size());
    placed_.weights.resize(positions.size());
    each_of(positions.size(), slabs_, [&](std::size_t p) {
        placed_.position[p] = positions[p];
        locate(p);
    });
    FaceDeposit::clear(fraction_, slabs_);
    double* const fraction = fraction_.data();
    deposit([=](std::size_t, std::ptrdiff_t to, double share) { fraction[to] += share; });
    over_cells_.densities(fraction_, scratch_, slabs_);
    fill_ghosts(fraction_, grid_, edges_, slabs_);
}

void SolidsVolume::mean(std::span<const Vec3> property, std::array<flow::Field, 3>& into) {
    for (auto& field : into) FaceDeposit::clear(field, slabs_);
    const std::array<double*, 3> sums{into[0].data(), into[1].data(), into[2].data()};
    deposit([&](std::size_t p, std::ptrdiff_t to, double share) {
        for (std::size_t d = 0; d < 3; ++d) sums[d][to] += share * property[p][d];
    });
    for (auto& field : into) {
        over_cells_.densities(field, scratch_, slabs_);
        each_cell(grid_, slabs_, [&](int i, int j, int k) {
            const double phi = fraction_(i, j, k);
            double& value = field(i, j, k);
            value = phi > 0 ? value / phi : 0;
        });
    }
    fill_ghosts({{into[0], edges_}, {into[1], edges_}, {into[2], edges_}}, grid_, slabs_);
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
void SolidsVolume::carry_along(const std::array<Shares, 3>& shares, double scale, const flow::Planes& planes) {
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
            const int place_b = inside(B, shares[B].first + static_cast<int>(b));
            if (B == 2 && (place_b < planes.first || place_b > planes.last)) continue;
            const auto line =
                inside(A, shares[A].first + static_cast<int>(a)) * flux_[D].stride(A) + place_b * flux_[D].stride(B);
            double passed = 0;
            for (std::size_t c = 0; c + 1 < own.before.size(); ++c) {
                passed -= own.change[c] * across;
                const int place = inside(D, own.first + static_cast<int>(c) + 1);
                if (D == 2 && (place < planes.first || place > planes.last)) continue;
                flux[line + place * stride] += passed;
            }
        }
}

flow::Planes SolidsVolume::planes_between(std::size_t p) const {
    const int from = placed_before_.weights[p][2].first;
    const int to = placed_.weights[p][2].first;
    const int low = std::min(from, to);
    const int high = std::max(from, to) + 1;
    if (edges_[2].periodic) return {0, grid_.cells(2) + 1};
    return {low - 1, high + 1};  // shares beyond a wall are folded into its cell
}

void SolidsVolume::carry(double dt) {
    FaceDeposit::clear(flux_, slabs_);
    cuts_.make(placed_.position.size(), grid_.cells(2) + 2, slabs_, [&](std::size_t p) { return planes_between(p); });
    const double scale = particle_volume_ / dt;
    cuts_.each(slabs_, [&](std::size_t p, const flow::Planes& own) {
        thread_local std::array<Shares, 3> shares;  // keeps its memory
        for (int d = 0; d < 3; ++d) fill(d, p, shares[at(d)]);
        carry_along<0>(shares, scale, own);
        carry_along<1>(shares, scale, own);
        carry_along<2>(shares, scale, own);
    });
    each_of(placed_.position.size(), slabs_, [&](std::size_t p) {
        placed_before_.position[p] = placed_.position[p];
        placed_before_.weights[p] = placed_.weights[p];
    });
    for (int d = 0; d < 3; ++d) over_faces_[at(d)].densities(flux_[at(d)], scratch_, slabs_);
}

double SolidsVolume::largest_fraction() const {
    const double* const values = fraction_.data();
    std::vector<double> largest(static_cast<std::size_t>(slabs_.count()), values[0]);
    slabs_.each([&](int slab) {
        const auto size = static_cast<std::ptrdiff_t>(fraction_.size());
        double most = -std::numeric_limits<double>::infinity();
        for (auto m = size * slab / slabs_.count(); m < size * (slab + 1) / slabs_.count(); ++m)
            most = values[m] > most ? values[m] : most;  // NaN is ignored
        largest[static_cast<std::size_t>(slab)] = most;
    });
    if (std::isnan(values[0])) return values[0];
    return *std::max_element(largest.begin(), largest.end());
}

}  // namespace grainsweep::coupling
