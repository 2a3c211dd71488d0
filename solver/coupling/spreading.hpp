// How wide a particle is to the fluid: the kernel that spreads what it gives (force, volume) over the grid.
//
// A deposit on the nearest nodes has the width of cells. To be that of a length w on every grid, also where cells are
// thin, it is spread by the heat equation along each axis, whose kernel is the Gaussian of standard deviation w:
//     d phi/dt = d/dx ( s d phi/dx ),  t = 0 ... 1,   s = (w^2 - h^2/6)/2 >= 0,   no flux through walls,
// exactly in t by the matrix exponential of the second difference (diffusion-based averaging: Sun & Xiao 2015, doi
// 10.1016/j.ijmultiphaseflow.2014.11.014, whose bandwidth b is sqrt(2) w; axis by axis because a Gaussian is a
// product). h^2/6 is what the linear deposit has already, h the local cell: the variance is w^2 where h < 2.4 w and
// that of the cell beyond. Conservative, positive, and its own transpose between deposits and densities, to the
// round-off of the exponential: 1e-15 at w of a cell, 1e-10 where w is hundred thin cells.
//
// Linear weights between the centres of unequal cells sum to 1. But a uniform density leaves (h_{i-1} + 2 h_i +
// h_{i+1})/4 on cell i and (3 h_1 + h_2)/4 on the cell at a wall, not its width. A cloud would seem 7 % denser at the
// walls of 20 cells clustered by 1.5. Before anything else, what is too much below a face, (h_i - h_{i-1})/4, is moved
// over it as a share of the cell that has it. Sums stay, a uniform density leaves the widths, a deposit moves by h^2 at
// most.
#pragma once

#include "solver/flow/axis_product.hpp"
#include "solver/flow/boundary.hpp"

#include <Eigen/Core>

#include <array>

namespace grainsweep::coupling {

/// Where a deposit lies along an axis, with indices as a field's.
enum class Nodes {
    cells,  ///< per cell
    faces,  ///< per face between cells; faces on walls hold nothing
    flux    ///< through faces, none through walls: spread such that its divergence is the spread divergence
};

/// The n x n kernel along one axis, indices 1 ... n, from densities (per length; fluxes for Nodes::flux) to densities.
[[nodiscard]] Eigen::MatrixXd spreading_matrix(const flow::Axis& axis, bool periodic, Nodes nodes, double width);
/// The lengths the nodes stand for: deposit = density x length; 0 for a face on a wall, 1 for Nodes::flux.
[[nodiscard]] Eigen::VectorXd node_lengths(const flow::Axis& axis, bool periodic, Nodes nodes);

/// What a cloud of uniform density leaves on cells of unequal width (Trilinear, Solenoidal).
enum class Hats {
    linear,  ///< weights linear between centres: to be levelled
    metric   ///< weights scaled with the widths: the widths already
};

/// Returns the n x n matrix that levels linear deposits. On cells, columns sum to 1 (see above). On fluxes it is what
/// levelling carries through faces, so the divergence of a levelled flux is the levelled divergence.
[[nodiscard]] Eigen::MatrixXd levelling_matrix(const flow::Axis& axis, bool periodic, Nodes nodes);

/// The kernel of a field on the grid.
class Spreading {
public:
    /// Two fields of the grid to work in.
    using Scratch = std::array<flow::Field, 2>;

    /// width: standard deviation, 0 for none beyond the deposit's own.
    Spreading(const flow::Grid& grid, const std::array<bool, 3>& periodic, const std::array<Nodes, 3>& nodes,
              double width, Hats hats = Hats::linear);

    /// Extensive deposits, none on ghosts -> densities. Ghosts are left alone, here and below.
    void densities(flow::Field& field, Scratch& scratch, const Slabs& slabs = {}) const;
    /// Densities -> densities, the transpose of `densities` against deposits: sum of deposit . spread(u) is that of
    /// densities(deposit) . u over the volume.
    void spread(flow::Field& field, Scratch& scratch, const Slabs& slabs = {}) const;

private:
    void apply(const std::array<flow::AxisProduct, 3>& kernels, flow::Field& field, Scratch& scratch,
               const Slabs& slabs) const;

    int planes_;  // inner ones
    std::array<flow::AxisProduct, 3> from_deposits_, from_densities_;
};

}  // namespace grainsweep::coupling
