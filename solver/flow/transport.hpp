// Convection and diffusion on the staggered grid, second order.
//
// Convection in divergence form. The advected value on a face is the plain average of its two neighbours, and the
// advecting flux is the exact flux through that face. So convection in a divergence-free field conserves kinetic energy
// and temperature variance, on any tensor grid
// (Harlow & Welch 1965, doi 10.1063/1.1761178; Verstappen & Veldman 2003, doi 10.1016/S0021-9991(03)00126-8).
#pragma once

#include "solver/flow/boundary.hpp"
#include "solver/flow/second_difference.hpp"

#include <array>
#include <vector>

namespace grainsweep::flow {

/// One-dimensional weights of one staggered field, per axis, with the indices of the field.
struct Weights {
    std::array<std::vector<double>, 3> low, high;      ///< second difference
    std::array<std::vector<double>, 3> inverse_width;  ///< of the control volume
    std::array<std::vector<double>, 3> lower, upper;   ///< shares of the cells below and above a face in its volume
    std::array<int, 3> first{};                        ///< first unknown index

    Weights(const Grid& grid, const Edges& edges);
};

/// Computes convection = -div(V v_d) and diffusion = nu lap v_d on the unknown faces of direction d. Ghosts must be
/// filled.
void momentum_transport(int d, const FaceVectors& velocity, const Weights& weights, const std::array<int, 3>& cells,
                        double viscosity, Field& convection, Field& diffusion, const Planes& planes = {});

/// Computes convection = -div(V theta) and diffusion = kappa lap theta on the cells. Ghosts must be filled.
void scalar_transport(const FaceVectors& velocity, const Field& scalar, const Weights& weights,
                      const std::array<int, 3>& cells, double diffusivity, Field& convection, Field& diffusion,
                      const Planes& planes = {});

/// Computes div V on the cells, compact (nz, ny, nx); `result` must have this size.
void divergence(const FaceVectors& velocity, const Weights& cell_weights, const std::array<int, 3>& cells,
                std::vector<double>& result, const Planes& planes = {});

}  // namespace grainsweep::flow
