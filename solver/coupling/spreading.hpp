// Kernel that spreads the force and the volume of particles over the grid.
//
// A deposit on the nearest nodes is as wide as the cells. To have the width w on every grid, it is spread by the heat
// equation along each axis, whose kernel is the Gaussian of standard deviation w:
//     d phi/dt = d/dx ( s d phi/dx ),  t = 0 ... 1,   s = (w^2 - h^2/6)/2 >= 0,   no flux through walls,
// solved exactly in t by the matrix exponential of the second difference. This is diffusion-based averaging (Sun & Xiao
// 2015, doi 10.1016/j.ijmultiphaseflow.2014.11.014, whose bandwidth b is sqrt(2) w), axis by axis because a Gaussian is
// a product. The linear deposit already has the variance h^2/6, h the local cell width. So the variance is w^2 for h <
// 2.4 w, and h^2/6 for wider cells. The kernel is conservative, positive, and its own transpose between deposits and
// densities, to the round-off of the exponential: 1e-15 for w of one cell, 1e-10 for w of a hundred thin cells.
//
// Levelling: linear weights between the centres of unequal cells sum to 1, but a uniform density deposits (h_{i-1} + 2
// h_i + h_{i+1})/4 on cell i and (3 h_1 + h_2)/4 on the cell at a wall, instead of the cell's width. With 20 cells
// clustered by 1.5, a cloud would seem 7 % denser at the walls. Therefore the surplus below a face, (h_i - h_{i-1})/4,
// is first moved over the face as a share of its cell. Sums do not change, a uniform density gives the widths, and a
// deposit moves by at most h^2.
#pragma once

#include "solver/flow/axis_product.hpp"
#include "solver/flow/boundary.hpp"

#include <Eigen/Core>

#include <array>

namespace grainsweep::coupling {

/// Nodes of a deposit along an axis, with the indices of a field.
enum class Nodes {
    cells,  ///< per cell
    faces,  ///< per face between cells; faces on walls have no deposit
    flux    ///< through faces, none through walls: spread such that its divergence is the spread divergence
};

/// Returns the n x n kernel along one axis, indices 1 ... n, from densities (per length; fluxes for Nodes::flux) to
/// densities.
[[nodiscard]] Eigen::MatrixXd spreading_matrix(const flow::Axis& axis, bool periodic, Nodes nodes, double width);
/// Returns the lengths of the nodes: deposit = density x length; 0 for a face on a wall, 1 for Nodes::flux.
[[nodiscard]] Eigen::VectorXd node_lengths(const flow::Axis& axis, bool periodic, Nodes nodes);

/// Deposit of a uniform cloud on cells of unequal width.
enum class Hats {
    linear,  ///< weights linear between centres: levelling is needed
    metric   ///< weights scaled with the widths: no levelling
};

/// Returns the n x n matrix that levels linear deposits. On cells, columns sum to 1 (see above). On fluxes it is the
/// transport by levelling through faces, so the divergence of a levelled flux is the levelled divergence.
[[nodiscard]] Eigen::MatrixXd levelling_matrix(const flow::Axis& axis, bool periodic, Nodes nodes);

/// Kernel of a field on the grid.
class Spreading {
public:
    /// Scratch memory: two fields of the grid.
    using Scratch = std::array<flow::Field, 2>;

    /// width: standard deviation; 0: only the width of the deposit itself.
    Spreading(const flow::Grid& grid, const std::array<bool, 3>& periodic, const std::array<Nodes, 3>& nodes,
              double width, Hats hats = Hats::linear);

    /// Converts extensive deposits, none on ghosts, to densities. Ghosts do not change, here and below.
    void densities(flow::Field& field, Scratch& scratch, const Slabs& slabs = {}) const;
    /// Spreads densities by the transpose of densities(): the sum of deposit . spread(u) equals the sum of
    /// densities(deposit) . u times volume.
    void spread(flow::Field& field, Scratch& scratch, const Slabs& slabs = {}) const;

private:
    void apply(const std::array<flow::AxisProduct, 3>& kernels, flow::Field& field, Scratch& scratch,
               const Slabs& slabs) const;

    int planes_;  // inner ones
    std::array<flow::AxisProduct, 3> from_deposits_, from_densities_;
};

}  // namespace grainsweep::coupling
