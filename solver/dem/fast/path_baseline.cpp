// Kernels compiled for processors other than x86: NEON of AArch64. Only the function at the end may have external
// linkage.
#include "solver/dem/fast/pair_lanes.hpp"

#include "solver/dem/fast/compiled_laws.hpp"

namespace grainsweep::dem::fast {

const Kernels& baseline_kernels(const Needs& needs) {
    return choose(Compiled{}, needs);
}

}  // namespace grainsweep::dem::fast
