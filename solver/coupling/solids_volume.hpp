// Volume of the particles on the grid: fraction phi_p of each cell and flux j through each face.
//
// A particle's volume is shared among the cell centres around it by trilinear weights, then spread over the width of
// the kernel (spreading.hpp). The flux moves each particle's shares from its old to its new place by the density
// decomposition of Esirkepov 2001 (doi 10.1016/S0010-4655(00)00228-9, eq. 23), so that
//   phi_p(new) = phi_p(old) - dt div j
// holds in every cell to round-off, for any motion and any tensor-product grid, also after spreading.
#pragma once

#include "solver/coupling/interpolation.hpp"
#include "solver/coupling/plane_cuts.hpp"

#include <span>
#include <vector>

namespace grainsweep::coupling {

/// Returns the fraction of a single particle at its place, far from walls: v_p/(2 pi w^2)^(3/2). The width is at least
/// the width of a linear deposit in a mean cell; the result is at least v_p divided by the volume of the box.
[[nodiscard]] double lone_fraction(const flow::Grid& grid, double particle_volume, double kernel_width);

class SolidsVolume {
public:
    /// kernel_width: see spreading.hpp.
    SolidsVolume(const flow::Grid& grid, const flow::Sides& sides, double particle_volume, double kernel_width);

    /// Sets the threads that compute; no bit depends on their number.
    void use(const Slabs& slabs) { slabs_ = slabs; }

    /// Computes phi_p of particles that start from `positions` (inside the box), ghosts filled.
    void start(std::span<const Vec3> positions);
    /// Computes phi_p of the same particles at `positions`; carry() uses the last call.
    void place(std::span<const Vec3> positions);
    /// Computes j of the particles for their motion in dt: from the positions at start(), or at the last carry(), to
    /// the present ones. Along periodic axes the way is the shortest one.
    void carry(double dt);
    /// Computes the mean of a particle property in each cell, weighted like phi_p: sum v_p w q / sum v_p w; 0 without
    /// particles. Ghosts have zero gradient.
    void mean(std::span<const Vec3> property, std::array<flow::Field, 3>& into);

    [[nodiscard]] const flow::Field& fraction() const { return fraction_; }
    [[nodiscard]] const flow::FaceVectors& flux() const { return flux_; }
    /// Returns the flux, to be restored for the next step; the fraction follows from the positions.
    [[nodiscard]] flow::FaceVectors& flux() { return flux_; }
    [[nodiscard]] const flow::Edges& edges() const { return edges_; }
    [[nodiscard]] double largest_fraction() const;

private:
    // Places of the particles: weights of two neighbouring cells per axis, `first` (0 ... n+1, folded later) and the
    // next. Computed once for three uses.
    struct Placement {
        std::vector<Vec3> position;
        std::vector<std::array<AxisWeights<2>, 3>> weights;
    };
    // Shares of one particle among the cells of one axis, from index `first`.
    struct Shares {
        int first = 0;
        std::vector<double> before, change;
    };
    [[nodiscard]] int inside(int d, int cell) const;  // folded at walls, wrapped along periodic axes
    [[nodiscard]] flow::Planes planes_of(const AxisWeights<2>& along_z) const;
    [[nodiscard]] flow::Planes planes_between(std::size_t p) const;  // planes of its position at the last carry() and
                                                                     // now
    void locate(std::size_t p);
    // Calls body(p, index in the field, volume of p there) for each index in the order of the particles.
    template <class Body>
    void deposit(Body body);
    void fill(int d, std::size_t p, Shares& shares) const;
    template <int D>
    void carry_along(const std::array<Shares, 3>& shares, double scale, const flow::Planes& planes);

    flow::Grid grid_;
    flow::Edges edges_;
    double particle_volume_;
    Spreading over_cells_;
    std::vector<Spreading> over_faces_;
    Spreading::Scratch scratch_;
    Placement placed_before_, placed_;  // at the last carry(); now
    flow::Field fraction_;
    flow::FaceVectors flux_;
    PlaneCuts cuts_;
    Slabs slabs_;
};

}  // namespace grainsweep::coupling
