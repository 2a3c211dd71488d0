// Clones of a function for wider vectors, chosen by the loader.
//
// The kernels marked with this work element by element. They use additions, products, quotients, square roots and bits,
// which round the same way everywhere. No sum is reordered and nothing is fused (-ffp-contract=off, AVX2 without FMA),
// so every clone returns the same bits.
#pragma once

#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__linux__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define GRAINSWEEP_VECTOR_CLONES [[gnu::target_clones("avx2", "default")]]
#else
#define GRAINSWEEP_VECTOR_CLONES
#endif
