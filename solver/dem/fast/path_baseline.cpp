// The kernels compiled for what every processor this program runs on has: x86-64-v2, or NEON of AArch64.
// Nothing with external linkage but the one function at the end may come into being here.
#include "solver/dem/fast/pair_lanes.hpp"

#include "solver/dem/fast/compiled_laws.hpp"

namespace grainsweep::dem::fast {

const Kernels& baseline_kernels(const Needs& needs) {
    return choose(Compiled{}, needs);
}

}  // namespace grainsweep::dem::fast
