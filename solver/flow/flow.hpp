// Incompressible flow in a box, with or without heat:
//
//   div V = 0                                                                                        (1)
//   dV/dt + div(V V) = -grad p + nu lap V + B theta s(t) e_g + a                                      (2)
//   dtheta/dt + div(V theta) = kappa lap theta                                                       (3)
//
// (2) with B = -Pr Ra_omega, s(t) = sin(Omega t + phase), e_g the direction of vibration, nu = Pr, kappa = 1 is the
// Boussinesq flow in a vibrated cavity (length L, time L^2/alpha, theta = (T - T0)/DT; Gershuni & Lyubimov 1998);
// s = 1 is natural convection under steady gravity. `a` is any other acceleration given on the faces.
//
// Scheme on a staggered grid:
//   space       central differences (transport.hpp)
//   convection  Adams-Bashforth, Euler in the first step
//   diffusion   Crank-Nicolson, factored by direction (implicit_diffusion.hpp)
//   pressure    incremental projection in rotational form (Timmermans, Minev & van de Vosse 1996; Brown, Cortez &
//               Minion 2001, doi 10.1006/jcph.2001.6715)
//
//   theta^{n+1} from (3);  theta^{n+1/2} = (theta^n + theta^{n+1})/2
//   (1 - nu dt/2 lap)(V* - V^n) = dt [ 3/2 C^n - 1/2 C^{n-1} + nu lap V^n - grad p + B theta^{n+1/2} s e_g + a ]
//   lap q = div V*/dt,  V^{n+1} = V* - dt grad q,  p += q - nu/2 div V*
// Second order in space and time; div V = 0 to round-off after every step. The first step solves for a consistent
// pressure and projects the initial velocity.
#pragma once

#include "solver/flow/heat.hpp"
#include "solver/flow/implicit_diffusion.hpp"
#include "solver/flow/poisson.hpp"
#include "solver/flow/transport.hpp"

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace grainsweep::flow {

struct FlowSetup {
    Grid grid;
    Sides sides{};
    double viscosity = 1;  ///< nu
    double time_step = 0;  ///< dt > 0
};

using VectorFunction = std::function<std::array<double, 3>(double x, double y, double z)>;

template <class Heat>
class Flow {
public:
    /// Throws std::invalid_argument for an impossible setup.
    Flow(const FlowSetup& setup, const Heat& heat);

    /// Sets initial values, sampled at faces and cell centres. Without them the fluid is at rest and the temperature 0.
    void set_velocity(const VectorFunction& velocity);
    void set_temperature(const ScalarFunction& temperature) requires std::same_as<Heat, Boussinesq> {
        heat_.set(temperature);
    }

    /// Sets the threads that compute a step; no bit depends on their number.
    void use(const Slabs& slabs) { slabs_ = slabs; }

    /// Advances by one time step; `acceleration` (ghosts ignored) is the value at the middle of the step.
    void step();
    void step(const FaceVectors& acceleration);
    /// Advances by one time step in which buoyancy acts only on the share 1 - `occupied` of each cell (ghosts filled).
    void step(const FaceVectors& acceleration, const Field& occupied);

    [[nodiscard]] const Grid& grid() const { return setup_.grid; }
    [[nodiscard]] const Sides& sides() const { return setup_.sides; }
    [[nodiscard]] double viscosity() const { return setup_.viscosity; }
    [[nodiscard]] std::int64_t steps() const { return steps_; }
    [[nodiscard]] double time_step() const { return setup_.time_step; }
    [[nodiscard]] double time() const { return static_cast<double>(steps_) * setup_.time_step; }
    [[nodiscard]] const FaceVectors& velocity() const { return velocity_; }  ///< ghosts filled
    [[nodiscard]] const Field& pressure() const { return pressure_; }
    [[nodiscard]] const Field& temperature() const requires std::same_as<Heat, Boussinesq> {
        return heat_.temperature();
    }

    /// Computes the flow between the last two time levels for particles, on the faces, ghosts filled:
    /// velocity (V^n + V^{n+1})/2 and fluid acceleration DV/Dt = (V^{n+1} - V^n)/dt - (3/2 C^n - 1/2 C^{n-1}).
    void midpoint(FaceVectors& velocity, FaceVectors& acceleration) const;

    /// Returns the largest |div V| of the cells.
    [[nodiscard]] double largest_divergence() const;

    struct Fastest {
        double courant = 0;  ///< |v_d| dt/h_d; NaN where a velocity is not finite
        int component = 0;
        std::array<double, 3> position{};
    };
    /// Returns the face with the largest Courant number, or the first with NaN.
    [[nodiscard]] Fastest fastest() const;

    /// Saves the complete state; a flow of the same setup restored from it continues with the same bits.
    void save(std::vector<std::byte>& into) const;
    /// Restores the state and removes its bytes from the front of `from`. Throws std::invalid_argument if there are too
    /// few.
    void restore(std::span<const std::byte>& from);

private:
    void start();
    void advance(const FaceVectors* acceleration, const Field* occupied);
    void assemble(int d, const FaceVectors* acceleration, const Field* occupied, const Planes& planes);
    void project();

    FlowSetup setup_;
    std::array<int, 3> cells_;
    std::array<Edges, 3> edges_;
    Edges pressure_edges_;
    std::array<Weights, 3> weights_;
    Weights cell_weights_;
    std::array<std::vector<double>, 3> inverse_spacing_;
    std::vector<ImplicitDiffusion> diffusion_;
    Poisson poisson_;
    [[no_unique_address]] HeatState<Heat> heat_;

    FaceVectors velocity_, previous_;
    std::array<FaceVectors, 2> convection_;  // C^n, C^{n-1}
    Field pressure_, increment_, right_, change_;
    std::vector<double> divergence_, potential_;
    std::int64_t steps_ = 0;
    Slabs slabs_;
};

extern template class Flow<NoHeat>;
extern template class Flow<Boussinesq>;

}  // namespace grainsweep::flow
