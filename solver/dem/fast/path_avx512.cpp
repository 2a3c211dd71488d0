// The kernels compiled for AVX-512 F, DQ, BW, VL.
// Nothing with external linkage but the one function at the end may come into being here.
#include "solver/dem/fast/pair_lanes.hpp"

#include "solver/dem/fast/compiled_laws.hpp"

namespace grainsweep::dem::fast {

const Kernels& avx512_kernels(const Needs& needs) {
    return choose(Compiled{}, needs);
}

}  // namespace grainsweep::dem::fast
