// Direct solver of lap q = r on the cells by matrix diagonalisation, with zero gradient or periodic sides.
//
// The discrete Laplacian is a sum of three one-dimensional operators; with L_d = R_d diag(lambda_d) R_d^-1
//   q = (Rx x Ry x Rz) [ ((Rx^-1 x Ry^-1 x Rz^-1) r) / (lambda_x + lambda_y + lambda_z) ]
// (Lynch, Rice & Thomas 1964, doi 10.1007/BF01386067). It works on any tensor-product grid. A solution needs six
// products of n x n matrices with the field, which at n = 40 cost no more than a cosine transform. The constant mode is
// set to zero.
#pragma once

#include "solver/flow/boundary.hpp"

#include <vector>

namespace grainsweep::flow {

class Poisson {
public:
    Poisson(const Grid& grid, const Sides& sides);

    /// Replaces r by q: values (nz, ny, nx), x fastest, without ghosts.
    void solve(std::vector<double>& values, const Slabs& slabs = {});

private:
    enum class Way { forward, back };
    // Transforms the planes first ... last, from 0; along z these are indices on y.
    void transform(Way way, const std::vector<double>& from, std::vector<double>& to, int direction,
                   std::ptrdiff_t first, std::ptrdiff_t last) const;

    std::array<std::ptrdiff_t, 3> n_;
    // Row-major n x n. Along x the field is the left factor of the product, so these matrices are transposed.
    std::array<std::vector<double>, 3> forward_, back_;
    std::vector<double> inverse_eigenvalue_;
    std::vector<double> scratch_;
};

}  // namespace grainsweep::flow
