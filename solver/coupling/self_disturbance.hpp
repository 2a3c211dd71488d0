// Own wake: the flow that each particle causes at its own place, in closed form, subtracted from the gathered fluid
// velocity.
//
// By the unsteady Stokes equation in infinite space, a force spread over a Gaussian of variance s2 causes at its own
// place the velocity
//     u(t) = integral of F(t') G(t - t') dt',   G(T) = (nu T + s2/2)^(-3/2)/(12 pi^(3/2)),
// F per density of the fluid; steady u = F/(6 pi nu) sqrt(2/pi)/sqrt(s2). The drag law needs the velocity without this
// part. Otherwise a sphere of radius R settles too fast by R sqrt(2/pi)/sqrt(s2), 10 % at s = 8 R (Horwitz & Mani 2016,
// doi 10.1016/j.jcp.2016.04.034; the Gaussian's history as in Evrard, Denner & van Wachem 2020, doi
// 10.1016/j.jcp.2020.109591). Because x^(-3/2) = 2/sqrt(pi) times the integral of sqrt(k) exp(-k x) over k, G is
// approximated by a sum of exponentials. Each particle then needs only a few numbers, with decay rates nu k and source
// F.
//
// A no-slip wall at distance z reduces the steady u as for a point force: by F/(6 pi nu z) times 9/16 along the wall
// and 9/8 across it (Happel & Brenner 1983, ch. 7). An additional decay nu (9/16 m/z)^2 of every number, m = 1 along
// and 2 across, gives this reduction to first order in s/z, and u = 0 at the wall. Decays of several walls add.
#pragma once

#include "solver/coupling/levels.hpp"
#include "solver/coupling/walls.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

namespace grainsweep::coupling {

/// Sum of exponentials for a variance s2: u = sum of weight q, dq/dt = F - rate q.
class WakeModes {
public:
    /// Ratio of neighbouring wavenumbers; 3 gives G within 0.4 %.
    static constexpr double ratio = 3;
    static constexpr std::size_t count = 14;
    using Values = std::array<double, count>;

    /// least_variance > 0: smallest s2 anywhere; viscosity nu > 0.
    WakeModes(double least_variance, double viscosity) : least_variance_(least_variance) {
        double square = 40 / least_variance;  // k
        for (std::size_t m = count; m-- > 0; square /= ratio) {
            rate_[m] = viscosity * square;
            weight_[m] = std::log(ratio) * square * std::sqrt(square) * std::exp(-0.5 * square * least_variance) /
                         (6 * std::numbers::pi * std::numbers::pi);
        }
        least_square_ = square * ratio;
    }

    [[nodiscard]] const Values& rate() const { return rate_; }
    [[nodiscard]] Values weight(double variance) const {
        double narrower = std::exp(-0.5 * least_square_ * (variance - least_variance_));  // exp(-k (s2 - least)/2)
        Values weight = weight_;
        for (double& w : weight) {
            w *= narrower;
            narrower *= narrower * narrower;  // as k grows by the ratio
        }
        return weight;
    }

private:
    double least_variance_, least_square_ = 0;
    Values rate_{}, weight_{};
};

/// Two-way coupling in which the drag of a particle does not include its own wake.
class TwoWayWithoutOwnWake : public TwoWay {
public:
    static constexpr bool subtracts_own_wake = true;

    /// dt: time step; other arguments as of TwoWay.
    TwoWayWithoutOwnWake(const flow::Grid& grid, const flow::Sides& sides, const Sphere& sphere, std::size_t particles,
                         double kernel_width, double dt, Hats hats = Hats::linear)
        : TwoWay(grid, sides, sphere, particles, kernel_width, hats),
          grid_(grid),
          sphere_(sphere),
          width_(kernel_width),
          dt_(dt),
          modes_(least_variance(), sphere.prandtl),
          wakes_(particles) {
        for (std::size_t m = 0; m < WakeModes::count; ++m) {
            decay_[m] = std::exp(-modes_.rate()[m] * dt);
            gain_[m] = (1 - decay_[m]) / modes_.rate()[m];
        }
    }

    /// Subtracts the wake of particle p from the fluid gathered at x in the middle of the step, in this vibration.
    void subtract(std::size_t p, const Vec3& x, double vibration, const Walls& walls, Surroundings& around) {
        const Vec3 force = this->force(p, vibration);
        const double variance = variance_at(x);
        const auto weight = modes_.weight(variance);
        const Vec3 kept = kept_beside(x, walls, variance);
        Wake& wake = wakes_[p];
        for (std::size_t d = 0; d < 3; ++d) {
            double before = 0, after = 0;
            for (std::size_t m = 0; m < WakeModes::count; ++m) {
                double& q = wake[d][m];
                before += weight[m] * q;
                q = kept[d] * (decay_[m] * q + gain_[m] * force[d]);
                after += weight[m] * q;
            }
            around.velocity[d] -= 0.5 * (before + after);
            around.acceleration[d] -= (after - before) / dt_;
        }
    }

    void save(std::vector<std::byte>& into) const {
        TwoWay::save(into);
        append_bytes<Wake>(into, wakes_);
    }
    void restore(std::span<const std::byte>& from) {
        TwoWay::restore(from);
        take_bytes<Wake>(from, wakes_);
    }

private:
    using Wake = std::array<WakeModes::Values, 3>;

    // Returns the variance of a deposit over the width, at least a cell of width h, plus the variance of linear
    // gathering.
    [[nodiscard]] double variance_of(double h) const { return std::max(width_ * width_, h * h / 6) + h * h / 6; }
    [[nodiscard]] double variance_at(const Vec3& x) const {
        double sum = 0;
        for (int d = 0; d < 3; ++d) {
            const auto& axis = grid_[d];
            sum += variance_of(axis.width(axis.cell_at(x[static_cast<std::size_t>(d)])));
        }
        return sum / 3;
    }
    [[nodiscard]] double least_variance() const {
        double least = 0;
        for (int d = 0; d < 3; ++d) least += variance_of(grid_[d].width(1)) / 3;  // cells are smallest beside walls
        return least;
    }
    // Walls reflect tangential deposits, which affects a wake of width s below z = s.
    [[nodiscard]] Vec3 kept_beside(const Vec3& x, const Walls& walls, double variance) const {
        const double least = 0.1 * sphere_.radius();
        Vec3 closeness{};  // sum of (m/z)^2
        for (std::size_t wall = 0; wall < 3; ++wall) {
            if (walls.periodic[wall]) continue;
            for (const double z : {x[wall] - walls.low[wall], walls.high[wall] - x[wall]}) {
                const double square = std::max(z, least) * std::max(z, least);
                for (std::size_t d = 0; d < 3; ++d)
                    closeness[d] += d == wall ? 4 / square : 1 / (square + 0.25 * variance);
            }
        }
        Vec3 kept;
        for (std::size_t d = 0; d < 3; ++d) kept[d] = 1 / (1 + 81.0 / 256 * sphere_.prandtl * closeness[d] * dt_);
        return kept;
    }

    flow::Grid grid_;
    Sphere sphere_;
    double width_, dt_;
    WakeModes modes_;
    WakeModes::Values decay_{}, gain_{};
    std::vector<Wake> wakes_;
};

}  // namespace grainsweep::coupling
