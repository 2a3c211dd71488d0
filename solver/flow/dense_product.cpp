#include "solver/flow/dense_product.hpp"

#include "solver/flow/dense_tiles.hpp"

namespace grainsweep::flow {
namespace {

#if !defined(__x86_64__)
void dense_product_baseline(std::ptrdiff_t rows, std::ptrdiff_t columns, std::ptrdiff_t depth, const double* a,
                            std::ptrdiff_t a_row, const double* b, std::ptrdiff_t b_row, double* c,
                            std::ptrdiff_t c_row) {
    product<Four, 4>(rows, columns, {depth, a, a_row, b, b_row, c, c_row});
}
#endif

// A fact of the processor, and none of the answer's.
DenseProduct* widest() {
#if defined(__x86_64__)
    return __builtin_cpu_supports("x86-64-v4") != 0 ? dense_product_avx512 : dense_product_avx2;
#else
    return dense_product_baseline;
#endif
}

}  // namespace

void dense_product(std::ptrdiff_t rows, std::ptrdiff_t columns, std::ptrdiff_t depth, const double* a,
                   std::ptrdiff_t a_row, const double* b, std::ptrdiff_t b_row, double* c, std::ptrdiff_t c_row) {
    static DenseProduct* const best = widest();
    best(rows, columns, depth, a, a_row, b, b_row, c, c_row);
}

}  // namespace grainsweep::flow
