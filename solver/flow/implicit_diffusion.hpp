// (1 - a Lx)(1 - a Ly)(1 - a Lz) x = r: the factored Crank-Nicolson step in increments.
//
// The factorisation differs from (1 - a lap) by a^2 Lx Ly + ..., with a = nu dt/2 an O(dt^2) term on the increment
// (Douglas & Gunn 1964, doi 10.1007/BF01386093). Lines along y and z are solved with the Thomas algorithm, all lines of
// a row together. Along x, and along periodic axes, the inverse of the n x n factor is applied as a matrix.
#pragma once

#include "solver/flow/axis_product.hpp"
#include "solver/flow/boundary.hpp"

#include <vector>

namespace grainsweep::flow {

class ImplicitDiffusion {
public:
    /// a >= 0: diffusivity times half the time step.
    ImplicitDiffusion(const Grid& grid, const Edges& edges, double a);

    /// Solves for indices 1 ... n; `right` is overwritten, ghosts of `solution` do not change.
    void solve(Field& right, Field& solution, const Slabs& slabs = {});

private:
    struct Sweep {
        std::vector<double> low, inverse_pivot, high_over_pivot;  // index as the field's
        int first = 1;
    };
    // Solves the lines along d, which is y or z, at these indices of the other axis.
    void sweep(int d, Field& field, int first, int last) const;

    std::array<int, 3> n_;
    std::array<bool, 3> by_matrix_{};
    std::array<Sweep, 3> sweeps_;
    std::array<AxisProduct, 3> inverse_;
    Field scratch_;
};

}  // namespace grainsweep::flow
