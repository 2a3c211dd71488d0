#include "solver/flow/dense_product.hpp"

#include "solver/flow/vector_clones.hpp"

#include <cstring>

namespace grainsweep::flow {
namespace {

using Four = double __attribute__((vector_size(32)));  // one AVX register, or two SSE ones

struct Operands {
    std::ptrdiff_t depth;
    const double* a;
    std::ptrdiff_t a_row;
    const double* b;
    std::ptrdiff_t b_row;
    double* c;
    std::ptrdiff_t c_row;
};

// Rows x (4 Vectors) entries of C at once, held in registers.
template <int Rows, int Vectors>
[[gnu::always_inline]] inline void tile(const Operands& o, std::ptrdiff_t row, std::ptrdiff_t column) {
    Four sum[Rows][Vectors] = {};
    const double* a = o.a + row * o.a_row;
    const double* b = o.b + column;
    for (std::ptrdiff_t k = 0; k < o.depth; ++k, b += o.b_row) {
        Four right[Vectors];
        for (int v = 0; v < Vectors; ++v) std::memcpy(&right[v], b + 4 * v, sizeof(Four));
        for (int r = 0; r < Rows; ++r) {
            const double left = a[r * o.a_row + k];
            for (int v = 0; v < Vectors; ++v) sum[r][v] += left * right[v];
        }
    }
    for (int r = 0; r < Rows; ++r)
        for (int v = 0; v < Vectors; ++v)
            std::memcpy(o.c + (row + r) * o.c_row + column + 4 * v, &sum[r][v], sizeof(Four));
}

template <int Rows>
[[gnu::always_inline]] inline void last_columns(const Operands& o, std::ptrdiff_t row, std::ptrdiff_t column,
                                                std::ptrdiff_t columns) {
    for (; column < columns; ++column)
        for (int r = 0; r < Rows; ++r) {
            double sum = 0;
            for (std::ptrdiff_t k = 0; k < o.depth; ++k)
                sum += o.a[(row + r) * o.a_row + k] * o.b[k * o.b_row + column];
            o.c[(row + r) * o.c_row + column] = sum;
        }
}

template <int Rows>
[[gnu::always_inline]] inline void row_block(const Operands& o, std::ptrdiff_t row, std::ptrdiff_t columns) {
    std::ptrdiff_t column = 0;
    for (; column + 8 <= columns; column += 8) tile<Rows, 2>(o, row, column);
    for (; column + 4 <= columns; column += 4) tile<Rows, 1>(o, row, column);
    last_columns<Rows>(o, row, column, columns);
}

}  // namespace

GRAINSWEEP_VECTOR_CLONES
void dense_product(std::ptrdiff_t rows, std::ptrdiff_t columns, std::ptrdiff_t depth, const double* a,
                   std::ptrdiff_t a_row, const double* b, std::ptrdiff_t b_row, double* c, std::ptrdiff_t c_row) {
    // The narrow panel of B (depth x panel) stays in the first-level cache while the rows of A pass by.
    constexpr std::ptrdiff_t panel = 40;
    for (std::ptrdiff_t start = 0; start < columns; start += panel) {
        const std::ptrdiff_t width = columns - start < panel ? columns - start : panel;
        const Operands o{depth, a, a_row, b + start, b_row, c + start, c_row};
        std::ptrdiff_t row = 0;
        for (; row + 4 <= rows; row += 4) row_block<4>(o, row, width);
        for (; row < rows; ++row) row_block<1>(o, row, width);
    }
}

}  // namespace grainsweep::flow
