// The kernels compiled for x86-64-v2: what every processor this program runs on has.
// Nothing with external linkage but the one function at the end may come into being here.
#include "solver/dem/fast/lanes_baseline.hpp"

#include "solver/dem/fast/compiled_laws.hpp"

namespace grainsweep::dem::fast {

const Kernels& baseline_kernels(const Needs& needs) {
    return choose(Compiled{}, needs);
}

}  // namespace grainsweep::dem::fast
