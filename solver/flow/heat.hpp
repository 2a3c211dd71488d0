// Heat in a flow, and the force it exerts: equation (3) of flow.hpp and the force B theta s(t) e_g of equation (2).
// Adams-Bashforth convection, Crank-Nicolson diffusion factored by direction.
#pragma once

#include "solver/flow/implicit_diffusion.hpp"
#include "solver/flow/transport.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace grainsweep::flow {

/// s(t) = sin(frequency t + phase); frequency 0: s = 1, a steady force.
struct Vibration {
    double frequency = 0;  ///< rad per unit time
    double phase = 0;      ///< rad
    [[nodiscard]] double at(double time) const { return frequency == 0 ? 1 : std::sin(frequency * time + phase); }
};

/// Fluid without temperature: no field, no equation, no force.
struct NoHeat {};

/// Fluid with temperature and buoyancy.
struct Boussinesq {
    double diffusivity = 1;  ///< kappa
    ThermalSides sides{};
    double buoyancy = 0;  ///< B: acceleration per unit temperature
    int direction = 1;    ///< axis of e_g
    Vibration vibration{};
};

using ScalarFunction = std::function<double(double x, double y, double z)>;

/// State of a kind of heat; empty for NoHeat.
template <class Heat>
class HeatState;

template <>
class HeatState<NoHeat> {
public:
    HeatState(const Grid&, const Sides&, double, const NoHeat&) {}
    void start() {}
    void step(const FaceVectors&, bool, const Slabs&) {}
    void add_force(int, double, Field&, const Planes&) const {}
    void remove_force(int, double, const Field&, Field&, const Planes&) const {}
    void save(std::vector<std::byte>&) const {}
    void restore(std::span<const std::byte>&) {}
};

template <>
class HeatState<Boussinesq> {
public:
    HeatState(const Grid& grid, const Sides& sides, double time_step, const Boussinesq& heat);
    void start();  ///< sets theta^{n+1/2} = theta^n and fills ghosts
    void step(const FaceVectors& velocity, bool first, const Slabs& slabs);
    /// Adds the buoyancy acceleration B theta^{n+1/2} s(time) to component d.
    void add_force(int d, double time, Field& acceleration, const Planes& planes) const;
    /// Subtracts this acceleration for the share `occupied` of each cell, ghosts filled.
    void remove_force(int d, double time, const Field& occupied, Field& acceleration, const Planes& planes) const;
    void save(std::vector<std::byte>& into) const;
    void restore(std::span<const std::byte>& from);

    [[nodiscard]] const Field& temperature() const { return temperature_; }
    void set(const ScalarFunction& temperature);

private:
    std::array<int, 3> cells_;
    double time_step_;
    Boussinesq heat_;
    Edges edges_;
    Grid grid_;
    Weights weights_;
    std::array<std::vector<double>, 3> face_lower_;  // share of the lower cell in a value interpolated to a face
    ImplicitDiffusion diffusion_;
    Field temperature_, middle_;  // theta^n; (theta^n + theta^{n+1})/2
    std::array<Field, 2> convection_;
    Field right_, change_;
};

}  // namespace grainsweep::flow
