// C = A B for the small row-major matrices of the tensor-product solvers.
//
// Every entry of C is summed over k = 0, 1, ... in this order for any blocking and vector width. The bits depend
// neither on the processor nor on the shape; Eigen's product (compared in the tests) guarantees neither.
#pragma once

#include <cstddef>

namespace grainsweep::flow {

/// Computes C (rows x columns) = A (rows x depth) B (depth x columns); *_row: distance between rows in memory.
/// C must not overlap A or B.
void dense_product(std::ptrdiff_t rows, std::ptrdiff_t columns, std::ptrdiff_t depth, const double* a,
                   std::ptrdiff_t a_row, const double* b, std::ptrdiff_t b_row, double* c, std::ptrdiff_t c_row);

}  // namespace grainsweep::flow
