// Product of dense_product.hpp in tiles that stay in registers, for one width of vectors. One file per instruction set
// includes it, with internal linkage. Multiplications and additions are never fused, so all versions give the same
// bits.
#pragma once

#include <cstddef>
#include <cstring>

namespace grainsweep::flow {
namespace {

using Four = double __attribute__((vector_size(32)));   // one AVX register, or two SSE ones
using Eight = double __attribute__((vector_size(64)));  // one AVX-512 register

struct Operands {
    std::ptrdiff_t depth;
    const double* a;
    std::ptrdiff_t a_row;
    const double* b;
    std::ptrdiff_t b_row;
    double* c;
    std::ptrdiff_t c_row;
};

// Computes Rows x Vectors vectors of C.
template <class Vector, int Rows, int Vectors>
[[gnu::always_inline]] inline void tile(const Operands& o, std::ptrdiff_t row, std::ptrdiff_t column) {
    constexpr int lanes = sizeof(Vector) / sizeof(double);
    Vector sum[Rows][Vectors];
    for (int r = 0; r < Rows; ++r)  // one by one: GCC zeroes a whole array in memory
        for (int v = 0; v < Vectors; ++v) sum[r][v] = Vector{};
    const double* a = o.a + row * o.a_row;
    const double* b = o.b + column;
    for (std::ptrdiff_t k = 0; k < o.depth; ++k, b += o.b_row) {
        Vector right[Vectors];
        for (int v = 0; v < Vectors; ++v) std::memcpy(&right[v], b + lanes * v, sizeof(Vector));
#pragma GCC unroll 8
        for (int r = 0; r < Rows; ++r) {
            const double left = a[r * o.a_row + k];
#pragma GCC unroll 2
            for (int v = 0; v < Vectors; ++v) sum[r][v] += left * right[v];
        }
    }
    for (int r = 0; r < Rows; ++r)
        for (int v = 0; v < Vectors; ++v)
            std::memcpy(o.c + (row + r) * o.c_row + column + lanes * v, &sum[r][v], sizeof(Vector));
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

template <class Wide, int Rows>
[[gnu::always_inline]] inline void row_block(const Operands& o, std::ptrdiff_t row, std::ptrdiff_t columns) {
    constexpr std::ptrdiff_t lanes = sizeof(Wide) / sizeof(double);
    std::ptrdiff_t column = 0;
    for (; column + 2 * lanes <= columns; column += 2 * lanes) tile<Wide, Rows, 2>(o, row, column);
    for (; column + lanes <= columns; column += lanes) tile<Wide, Rows, 1>(o, row, column);
    if constexpr (lanes > 4)
        for (; column + 4 <= columns; column += 4) tile<Four, Rows, 1>(o, row, column);
    last_columns<Rows>(o, row, column, columns);
}

// Loops over the rows of A while a narrow panel of B (depth x panel) stays in the first-level cache.
template <class Wide, int Rows>
void product(std::ptrdiff_t rows, std::ptrdiff_t columns, Operands o) {
    constexpr std::ptrdiff_t panel = 40;
    for (std::ptrdiff_t start = 0; start < columns; start += panel, o.b += panel, o.c += panel) {
        const std::ptrdiff_t width = columns - start < panel ? columns - start : panel;
        std::ptrdiff_t row = 0;
        for (; row + Rows <= rows; row += Rows) row_block<Wide, Rows>(o, row, width);
        if constexpr (Rows > 4)
            for (; row + 4 <= rows; row += 4) row_block<Wide, 4>(o, row, width);
        for (; row < rows; ++row) row_block<Wide, 1>(o, row, width);
    }
}

}  // namespace

using DenseProduct = void(std::ptrdiff_t rows, std::ptrdiff_t columns, std::ptrdiff_t depth, const double* a,
                          std::ptrdiff_t a_row, const double* b, std::ptrdiff_t b_row, double* c, std::ptrdiff_t c_row);
DenseProduct dense_product_avx2, dense_product_avx512;

}  // namespace grainsweep::flow
