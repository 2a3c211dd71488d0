// The granular temperature Theta of the cells, a third of the variance of particle velocities, in two ways:
//
//   AlgebraicTemperature    production = dissipation in every cell (granular.hpp, balance)
//   TransportedTemperature  (3/2) [ d(xi a Theta)/dt + div(xi j Theta) ]
//                             = (-p_s I + tau_s) : grad v + div(k grad Theta) - gamma - 3 K Theta
// (Lun et al. 1984; Ding & Gidaspow 1990, doi 10.1002/aic.690360404; drag sink as in Fluent's eq. for a dilute gas).
//
// j is the exact particle flux of solids_volume.hpp, so upwinding j Theta keeps a uniform Theta uniform. Sinks are
// implicit with gamma = G sqrt(Theta^n) Theta^{n+1}: they relax within a thousandth of a step here. First order in
// time. Cells thinner than `thinnest` have no collisions: Theta stays at its least value there.
#pragma once

#include "solver/bytes.hpp"
#include "solver/coupling/granular.hpp"
#include "solver/coupling/solids_volume.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace grainsweep::coupling {

/// How the particles of a cell deform: S:S and div v of their mean velocity, central differences.
struct Straining {
    flow::Field shear, expansion;

    explicit Straining(const flow::Grid& grid) : shear(grid), expansion(grid) {}
    /// Threads that compute from now on; no bit depends on their number.
    void use(const Slabs& slabs) { slabs_ = slabs; }
    /// One-sided beside cells thinner than `thinnest`, which have too few particles for a mean velocity.
    void measure(const flow::Grid& grid, const flow::Field& fraction, const std::array<flow::Field, 3>& mean_velocity,
                 double thinnest);

private:
    Slabs slabs_;
};

struct TemperatureBounds {
    double least = 0;     ///< floor of Theta, and its value at the start
    double most = 1e12;   ///< ceiling
    double thinnest = 0;  ///< phi_p below which there are no collisions
};

class AlgebraicTemperature {
public:
    AlgebraicTemperature(const flow::Grid& grid, const Granular& grains, const TemperatureBounds& bounds);
    /// Threads that compute from now on; no bit depends on their number.
    void use(const Slabs& slabs) { slabs_ = slabs; }
    void advance(const SolidsVolume& solids, const Straining& straining, double dt);
    void rest(const SolidsVolume&) {}
    [[nodiscard]] const flow::Field& values() const { return values_; }
    void save(std::vector<std::byte>&) const {}  // follows from the particles
    void restore(std::span<const std::byte>&) {}

private:
    flow::Grid grid_;
    Granular grains_;
    TemperatureBounds bounds_;
    flow::Field values_;
    Slabs slabs_;
};

class TransportedTemperature {
public:
    TransportedTemperature(const flow::Grid& grid, const Granular& grains, const TemperatureBounds& bounds);
    /// Threads that compute from now on; no bit depends on their number.
    void use(const Slabs& slabs) { slabs_ = slabs; }
    /// From the fraction before to the fraction of `solids`, whose flux joins them.
    void advance(const SolidsVolume& solids, const Straining& straining, double dt);
    /// A step in which no cell has collisions.
    void rest(const SolidsVolume& solids);
    /// Theta everywhere, instead of its least value at the start.
    void set(double theta);
    [[nodiscard]] const flow::Field& values() const { return values_; }
    void save(std::vector<std::byte>& into) const;
    void restore(std::span<const std::byte>& from);

private:
    [[nodiscard]] double gain_by_neighbours(const SolidsVolume& solids, int i, int j, int k, double dt) const;

    flow::Grid grid_;
    Granular grains_;
    TemperatureBounds bounds_;
    flow::Field values_, next_;
    flow::Field fraction_;      // of the step before
    flow::Field conductivity_;  // k
    bool started_ = false;
    Slabs slabs_;
};

}  // namespace grainsweep::coupling
