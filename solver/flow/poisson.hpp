// lap q = r on the cells, zero gradient or periodic at the sides, solved exactly by matrix diagonalisation.
//
// The discrete Laplacian is a sum of three one-dimensional operators; with L_d = R_d diag(lambda_d) R_d^-1
//   q = (Rx x Ry x Rz) [ ((Rx^-1 x Ry^-1 x Rz^-1) r) / (lambda_x + lambda_y + lambda_z) ]
// (Lynch, Rice & Thomas 1964, doi 10.1007/BF01386067). Any tensor-product grid; six products of n x n matrices
// with the field, which at n = 40 costs no more than a cosine transform. The constant mode is set to zero.
#pragma once

#include "solver/flow/boundary.hpp"

#include <vector>

namespace grainsweep::flow {

class Poisson {
public:
    Poisson(const Grid& grid, const Sides& sides);

    /// In place: values (nz, ny, nx), x fastest, without ghosts: r -> q.
    void solve(std::vector<double>& values, const Slabs& slabs = {});

private:
    enum class Way { forward, back };
    // Part first ... last, from 0 on, of the planes, or along z of the places on y.
    void transform(Way way, const std::vector<double>& from, std::vector<double>& to, int direction,
                   std::ptrdiff_t first, std::ptrdiff_t last) const;

    std::array<std::ptrdiff_t, 3> n_;
    // Row-major n x n. Along x the field stands on the left of the product, so there the matrices are transposed.
    std::array<std::vector<double>, 3> forward_, back_;
    std::vector<double> inverse_eigenvalue_;
    std::vector<double> scratch_;
};

}  // namespace grainsweep::flow
