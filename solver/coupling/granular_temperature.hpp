// Granular temperature Theta of the cells, a third of the variance of particle velocities, by two methods:
//
//   AlgebraicTemperature    production = dissipation in every cell (granular.hpp, balance)
//   TransportedTemperature  (3/2) [ d(xi a Theta)/dt + div(xi j Theta) ]
//                             = (-p_s I + tau_s) : grad v + div(k grad Theta) - gamma - 3 K Theta
// (Lun et al. 1984; Ding & Gidaspow 1990, doi 10.1002/aic.690360404; drag sink as in Fluent's eq. for a dilute gas).
//
// j is the exact particle flux of solids_volume.hpp, so upwinding j Theta keeps a uniform Theta uniform. Sinks are
// implicit with gamma = G sqrt(Theta^n) Theta^{n+1}, because they relax within a thousandth of a step. The method is
// first order in time. Cells with a fraction below `thinnest` have no collisions: Theta has its smallest value there.
#pragma once

#include "solver/bytes.hpp"
#include "solver/coupling/granular.hpp"
#include "solver/coupling/solids_volume.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace grainsweep::coupling {

/// Strain rate of the particles of a cell: S:S and div v of their mean velocity, by central differences.
struct Straining {
    flow::Field shear, expansion;

    explicit Straining(const flow::Grid& grid) : shear(grid), expansion(grid) {}
    /// Sets the threads that compute; no bit depends on their number.
    void use(const Slabs& slabs) { slabs_ = slabs; }
    /// Computes the strain rate. Differences are one-sided beside cells with a fraction below `thinnest`, which have
    /// too few particles for a mean velocity.
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
    /// Sets the threads that compute; no bit depends on their number.
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
    /// Sets the threads that compute; no bit depends on their number.
    void use(const Slabs& slabs) { slabs_ = slabs; }
    /// Advances from the previous fraction to the fraction of `solids`, with its flux.
    void advance(const SolidsVolume& solids, const Straining& straining, double dt);
    /// Makes a step in which no cell has collisions.
    void rest(const SolidsVolume& solids);
    /// Sets Theta everywhere, instead of its smallest value at the start.
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
