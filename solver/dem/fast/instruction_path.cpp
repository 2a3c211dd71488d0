#include "solver/dem/fast/instruction_path.hpp"

#include <stdexcept>

namespace grainsweep::dem::fast {

bool supports(Method::Path path) {
    switch (path) {
#if defined(__x86_64__)
        case Method::Path::avx512:
            return __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512bw") != 0 &&
                   __builtin_cpu_supports("avx512dq") != 0 && __builtin_cpu_supports("avx512vl") != 0 &&
                   supports(Method::Path::avx2);
        case Method::Path::avx2:
        case Method::Path::best:
            return __builtin_cpu_supports("x86-64-v3") != 0;
        default:
            return false;
#else
        default:
            return path == Method::Path::best || path == Method::Path::baseline;
#endif
    }
}

namespace {

Method::Path widest_path() {
#if defined(__x86_64__)
    return supports(Method::Path::avx512) ? Method::Path::avx512 : Method::Path::avx2;
#else
    return Method::Path::baseline;
#endif
}

/// A fact of the process like its processor: chosen at its start, before any engine is made.
Method::Path& preferred() {
    static Method::Path path = widest_path();
    return path;
}

}  // namespace

Method::Path best_path() {
    return preferred();
}

void prefer(Method::Path path) {
    if (!supports(path)) throw std::invalid_argument("this processor lacks the instructions of the path asked for");
    preferred() = path == Method::Path::best ? widest_path() : path;
}

const Kernels& kernels_of(Method::Path path, const Needs& needs) {
    switch (path) {
#if defined(__x86_64__)
        case Method::Path::avx512:
            return avx512_kernels(needs);
        default:
            return avx2_kernels(needs);
#else
        default:
            return baseline_kernels(needs);
#endif
    }
}

}  // namespace grainsweep::dem::fast
