// Periodic flow, stored as its mean and two harmonics, and particles carried by it:
//   V(x, t) = V0 + Vc1 cos wt + Vs1 sin wt + Vc2 cos 2wt + Vs2 sin 2wt,  and the same for the acceleration DV/Dt.
//
// One-way particles do not change the flow, so all cases with the same fluid share one periodic flow. Each node stores
// its ten numbers contiguously. A particle gathers the amplitudes once per step and evaluates them at the phase of the
// step, at a cost that does not depend on the grid. The cost is memory access, so the numbers have single precision: an
// error of 6e-8, while the grid's error is about one percent.
#pragma once

#include "solver/bytes.hpp"
#include "solver/coupling/cloud.hpp"
#include "solver/coupling/motion.hpp"
#include "solver/flow/field.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace grainsweep::coupling {

/// Accumulator of the harmonics of a flow during a period.
class PeriodSum {
public:
    static constexpr std::size_t terms = 5;
    using Node = std::array<double, 2 * terms>;  // velocity, then acceleration

    explicit PeriodSum(const flow::Grid& grid) : size_(flow::Field(grid).size()) {
        for (auto& nodes : amplitudes_) nodes.assign(size_, Node{});
    }

    /// Adds one of `samples` equal steps of a period, at `phase` (rad); fields with ghosts.
    void add(double phase, int samples, const flow::FaceVectors& velocity, const flow::FaceVectors& acceleration) {
        const std::array<double, terms> basis = shares(phase, samples);
        for (std::size_t d = 0; d < 3; ++d)
            for (std::size_t m = 0; m < size_; ++m)
                for (std::size_t t = 0; t < terms; ++t) {
                    amplitudes_[d][m][t] += basis[t] * velocity[d].values()[m];
                    amplitudes_[d][m][terms + t] += basis[t] * acceleration[d].values()[m];
                }
    }

    [[nodiscard]] const std::array<std::vector<Node>, 3>& amplitudes() const { return amplitudes_; }

    void save(std::vector<std::byte>& into) const {
        for (const auto& nodes : amplitudes_) append_bytes<Node>(into, nodes);
    }
    void restore(std::span<const std::byte>& from) {
        for (auto& nodes : amplitudes_) take_bytes<Node>(from, nodes);
    }

private:
    // Discrete Fourier weights on equidistant phases.
    static std::array<double, terms> shares(double phase, int samples) {
        const double one = 1.0 / samples;
        return {one, 2 * one * std::cos(phase), 2 * one * std::sin(phase), 2 * one * std::cos(2 * phase),
                2 * one * std::sin(2 * phase)};
    }

    std::size_t size_;
    std::array<std::vector<Node>, 3> amplitudes_;
};

class PeriodicFlow {
public:
    static constexpr std::size_t terms = PeriodSum::terms;

    explicit PeriodicFlow(const flow::Grid& grid) : shape_(grid) {
        for (auto& nodes : amplitudes_) nodes.assign(shape_.size(), Node{});
    }
    PeriodicFlow(const flow::Grid& grid, const PeriodSum& period) : PeriodicFlow(grid) {
        for (std::size_t d = 0; d < 3; ++d)
            for (std::size_t m = 0; m < shape_.size(); ++m)
                for (std::size_t t = 0; t < 2 * terms; ++t)
                    amplitudes_[d][m][t / 4][t % 4] = static_cast<float>(period.amplitudes()[d][m][t]);
    }

    /// Returns velocity and acceleration at a particle at `phase`.
    template <class Kernel>
    [[nodiscard]] Surroundings at(const Stencil<Kernel>& stencil, double phase) const {
        const double c = std::cos(phase);
        const double s = std::sin(phase);
        return at(stencil, {1, c, s, c * c - s * s, 2 * s * c});
    }
    /// Returns the same from the basis functions 1, cos, sin, cos 2, sin 2 of the phase.
    template <class Kernel>
    [[nodiscard]] Surroundings at(const Stencil<Kernel>& stencil, const std::array<double, terms>& basis) const {
        Surroundings around;
        component<0>(stencil, basis, around);
        component<1>(stencil, basis, around);
        component<2>(stencil, basis, around);
        return around;
    }

    /// Computes the velocity on all faces at `phase`, including ghosts.
    void velocity(double phase, flow::FaceVectors& into) const {
        const double c = std::cos(phase);
        const double s = std::sin(phase);
        const std::array<double, terms> basis{1, c, s, c * c - s * s, 2 * s * c};
        for (std::size_t d = 0; d < 3; ++d)
            for (std::size_t m = 0; m < shape_.size(); ++m) {
                double sum = 0;
                for (std::size_t t = 0; t < terms; ++t)
                    sum += basis[t] * static_cast<double>(amplitudes_[d][m][t / 4][t % 4]);
                into[d].values()[m] = sum;
            }
    }

    void save(std::vector<std::byte>& into) const {
        for (const auto& nodes : amplitudes_) append_bytes<Node>(into, nodes);
    }
    void restore(std::span<const std::byte>& from) {
        for (auto& nodes : amplitudes_) take_bytes<Node>(from, nodes);
    }

private:
    using Four = float __attribute__((vector_size(16)));
    using Node = std::array<Four, 3>;  // velocity, then acceleration; two entries are unused

    template <int D, class Kernel>
    void component(const Stencil<Kernel>& stencil, const std::array<double, terms>& basis, Surroundings& around) const {
        Four first{};
        Four second{};
        Four third{};
        const Node* const nodes = amplitudes_[D].data();
        stencil.template visit<D>(shape_, [&](std::ptrdiff_t at, double weight) {
            const Node& node = nodes[at];
            const auto w = static_cast<float>(weight);
            first += w * node[0];
            second += w * node[1];
            third += w * node[2];
        });
        const std::array<float, 2 * terms> sum{first[0],  first[1],  first[2],  first[3], second[0],
                                               second[1], second[2], second[3], third[0], third[1]};
        for (std::size_t t = 0; t < terms; ++t) {
            around.velocity[D] += basis[t] * static_cast<double>(sum[t]);
            around.acceleration[D] += basis[t] * static_cast<double>(sum[terms + t]);
        }
    }

    flow::Field shape_;
    std::array<std::vector<Node>, 3> amplitudes_;
};

}  // namespace grainsweep::coupling
