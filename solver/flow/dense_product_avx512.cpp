// Compiled for AVX-512. Nothing with external linkage but this function may come into being here.
#include "solver/flow/dense_tiles.hpp"

namespace grainsweep::flow {

void dense_product_avx512(std::ptrdiff_t rows, std::ptrdiff_t columns, std::ptrdiff_t depth, const double* a,
                          std::ptrdiff_t a_row, const double* b, std::ptrdiff_t b_row, double* c,
                          std::ptrdiff_t c_row) {
    product<Eight, 8>(rows, columns, {depth, a, a_row, b, b_row, c, c_row});
}

}  // namespace grainsweep::flow
