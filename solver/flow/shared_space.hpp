// Fluid that shares its space with particles: the share phi of each cell is fluid, phi_p = 1 - phi is particles.
//
//   d phi/dt + div(phi V) = 0                                                                        (1)
//   d(phi V)/dt + div(phi V V) = -grad p + div[ nu phi (grad V + grad V^T) ] + phi B theta s e_g + s_m  (2)
// (Anderson & Jackson 1967, doi 10.1021/i160021a001, for a Boussinesq fluid. The whole pressure gradient acts on the
// fluid, so s_m is the whole force of the particles. The form with phi grad p and a reduced s_m is the same equation:
// Zhou et al. 2010, doi 10.1017/S002211201000306X.)
//
// The total volume flux J = phi V + j with j = phi_p V_p is free of divergence. Therefore flow.hpp advances J:
//   dJ/dt + div(J J) = -grad p + nu lap J + B theta s e_g + a,    div J = 0,
// which equals (1) and (2) exactly with
//   a = s_m + dj/dt + div(J J - phi V V) + div[ nu phi (grad V + grad V^T) ] - nu lap J - phi_p B theta s e_g.
// Without particles J = V and every added term is zero. Differences are those of transport.hpp. All terms except the
// last are differences of fluxes or given forces, so momentum is conserved to round-off. J also carries the
// temperature: particles have the temperature of the fluid and its heat capacity per volume.
#pragma once

#include "solver/flow/transport.hpp"

namespace grainsweep::flow {

class SharedSpace {
public:
    /// Smallest share of fluid in a cell: 1 - 0.63, random close packing.
    static constexpr double least_fluid = 0.37;

    SharedSpace(const Grid& grid, const Sides& sides, double viscosity);

    /// Sets the threads that compute; no bit depends on their number.
    void use(const Slabs& slabs) { slabs_ = slabs; }

    /// Computes V = (J - j)/phi on the faces, ghosts filled. j needs no ghosts; phi_p does (fill_ghosts,
    /// pressure_edges).
    void interstitial(const FaceVectors& mixture, const FaceVectors& particle_flux, const Field& solids,
                      FaceVectors& velocity) const;

    /// Adds div(J J - phi V V) + div[nu phi (grad V + grad V^T)] - nu lap J to `acceleration`. J with ghosts.
    void add_excess(const FaceVectors& mixture, const FaceVectors& particle_flux, const Field& solids,
                    FaceVectors& acceleration);

private:
    // Rows of fluxes of a slab of one component.
    struct FluxRows {
        std::vector<double> gap_x, x_low, y_low, y_high, z_low, z_high;
    };
    void prepare(int d, FluxRows& rows) const;
    void add_excess_of(int d, const FaceVectors& mixture, const Field& solids, Field& acceleration,
                       const Planes& planes, FluxRows& rows) const;
    void fluid_flux(const FaceVectors& mixture, const FaceVectors& particle_flux, FaceVectors& flux) const;

    Grid grid_;
    std::array<int, 3> cells_;
    double viscosity_;
    std::array<Edges, 3> edges_;
    std::array<Weights, 3> weights_;
    std::array<std::vector<double>, 3> inverse_width_, inverse_spacing_;  // of cells; between centres, at faces
    FaceVectors velocity_, flux_;                                         // V and phi V
    std::vector<std::array<FluxRows, 3>> rows_;                           // of each slab
    Slabs slabs_;
};

}  // namespace grainsweep::flow
