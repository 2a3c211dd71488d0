#include "solver/coupling/granular_temperature.hpp"

#include "solver/coupling/each.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace grainsweep::coupling {

void Straining::measure(const flow::Grid& grid, const flow::Field& fraction,
                        const std::array<flow::Field, 3>& mean_velocity, double thinnest) {
    const double* const a = fraction.data();
    each_cell(grid, slabs_, [&](int i, int j, int k) {
        const auto here = fraction.index(i, j, k);
        shear.data()[here] = 0;
        expansion.data()[here] = 0;
        if (!(a[here] > thinnest)) return;
        std::array<std::array<double, 3>, 3> gradient{};  // [component][direction]
        const std::array<int, 3> cell{i, j, k};
        for (int e = 0; e < 3; ++e) {
            const auto m = static_cast<std::size_t>(e);
            const auto stride = fraction.stride(e);
            const auto below = a[here - stride] > thinnest ? here - stride : here;
            const auto above = a[here + stride] > thinnest ? here + stride : here;
            const double distance =
                (below == here ? 0 : grid[e].spacing(cell[m])) + (above == here ? 0 : grid[e].spacing(cell[m] + 1));
            if (!(distance > 0)) continue;
            for (std::size_t c = 0; c < 3; ++c)
                gradient[c][m] = (mean_velocity[c].data()[above] - mean_velocity[c].data()[below]) / distance;
        }
        for (std::size_t c = 0; c < 3; ++c) {
            expansion.data()[here] += gradient[c][c];
            for (std::size_t e = 0; e < 3; ++e) {
                const double s = 0.5 * (gradient[c][e] + gradient[e][c]);
                shear.data()[here] += s * s;
            }
        }
    });
}

AlgebraicTemperature::AlgebraicTemperature(const flow::Grid& grid, const Granular& grains,
                                           const TemperatureBounds& bounds)
    : grid_(grid), grains_(grains), bounds_(bounds), values_(grid) {
    std::fill(values_.values().begin(), values_.values().end(), bounds.least);
}

void AlgebraicTemperature::advance(const SolidsVolume& solids, const Straining& straining, double /*dt*/) {
    each_cell(grid_, slabs_, [&](int i, int j, int k) {
        const double a = solids.fraction()(i, j, k);
        values_(i, j, k) = a > bounds_.thinnest
                               ? std::max(bounds_.least, grains_.balance(a, straining.shear(i, j, k),
                                                                         straining.expansion(i, j, k), bounds_.most))
                               : bounds_.least;
    });
    fill_ghosts(values_, grid_, solids.edges(), slabs_);
}

TransportedTemperature::TransportedTemperature(const flow::Grid& grid, const Granular& grains,
                                               const TemperatureBounds& bounds)
    : grid_(grid), grains_(grains), bounds_(bounds), values_(grid), next_(grid), fraction_(grid), conductivity_(grid) {
    std::fill(values_.values().begin(), values_.values().end(), bounds.least);
}

// dt times what convection and conduction bring to xi a Theta of a cell, per 3/2 of it.
double TransportedTemperature::gain_by_neighbours(const SolidsVolume& solids, int i, int j, int k, double dt) const {
    const auto here = values_.index(i, j, k);
    const double* const theta = values_.data();
    const double* const conductivity = conductivity_.data();
    const std::array<int, 3> cell{i, j, k};
    double gain = 0;
    for (int d = 0; d < 3; ++d) {
        const auto m = static_cast<std::size_t>(d);
        const auto stride = values_.stride(d);
        const bool wrapped = solids.edges()[m].periodic && cell[m] == grid_.cells(d);
        const double* const flux = solids.flux()[m].data();
        const double in = flux[here];
        const double out = flux[wrapped ? here - (grid_.cells(d) - 1) * stride : here + stride];
        const double at_low = in > 0 ? theta[here - stride] : theta[here];
        const double at_high = out > 0 ? theta[here] : theta[here + stride];
        const auto conducted = [&](std::ptrdiff_t from, double spacing) {
            return 0.5 * (conductivity[from] + conductivity[here]) * (theta[from] - theta[here]) / spacing;
        };
        gain += dt / grid_[d].width(cell[m]) *
                (grains_.density_ratio * (in * at_low - out * at_high) +
                 (conducted(here - stride, grid_[d].spacing(cell[m])) +
                  conducted(here + stride, grid_[d].spacing(cell[m] + 1))) /
                     1.5);
    }
    return gain;
}

void TransportedTemperature::advance(const SolidsVolume& solids, const Straining& straining, double dt) {
    if (!started_) fraction_ = solids.fraction();
    started_ = true;
    fill_ghosts(values_, grid_, solids.edges(), slabs_);
    each_of(values_.size(), slabs_, [&](std::size_t m) {
        const double a = fraction_.data()[m];
        conductivity_.data()[m] = a > bounds_.thinnest ? grains_.conductivity(a) * std::sqrt(values_.data()[m]) : 0;
    });
    each_cell(grid_, slabs_, [&](int i, int j, int k) {
        const double a = solids.fraction()(i, j, k);
        double& next = next_(i, j, k);
        if (!(a > bounds_.thinnest)) {
            next = bounds_.least;
            return;
        }
        const double theta = values_(i, j, k);
        const double root = std::sqrt(theta);
        const double expansion = straining.expansion(i, j, k);
        const double work = grains_.pressure(a) * expansion;  // p_s div v per Theta: an expanding cell cools
        const double heating =
            2 * grains_.viscosity(a) * root * std::max(0.0, straining.shear(i, j, k) - expansion * expansion / 3);
        const double sink = grains_.dissipation(a) * root + 3 * grains_.drag * a + std::max(work, 0.0);
        const double before =
            grains_.density_ratio * fraction_(i, j, k) * theta + gain_by_neighbours(solids, i, j, k, dt);
        const double energy = 1.5 * before + dt * (heating + std::max(-work, 0.0) * theta);
        next = std::clamp(energy / (1.5 * grains_.density_ratio * a + dt * sink), bounds_.least, bounds_.most);
    });
    std::swap(values_, next_);
    fill_ghosts(values_, grid_, solids.edges(), slabs_);
    each_of(values_.size(), slabs_, [&](std::size_t m) { fraction_.data()[m] = solids.fraction().data()[m]; });
}

void TransportedTemperature::rest(const SolidsVolume& solids) {
    set(bounds_.least);
    fraction_ = solids.fraction();
    started_ = true;
}

void TransportedTemperature::set(double theta) {
    std::fill(values_.values().begin(), values_.values().end(), theta);
}

void TransportedTemperature::save(std::vector<std::byte>& into) const {
    append_bytes<double>(into, values_.values());
    append_bytes<double>(into, fraction_.values());
    append_bytes(into, static_cast<std::int64_t>(started_));
}

void TransportedTemperature::restore(std::span<const std::byte>& from) {
    take_bytes<double>(from, values_.values());
    take_bytes<double>(from, fraction_.values());
    std::int64_t started = 0;
    take_bytes(from, started);
    started_ = started != 0;
}

}  // namespace grainsweep::coupling
