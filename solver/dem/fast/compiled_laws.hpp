// The combinations of laws worth compiling, and the choice among them. Anything else runs with the general one,
// which contains every law: absent ones then have zero coefficients.
// Included by the files of the instruction paths; internal linkage on purpose.
#pragma once

#include "solver/dem/fast/search.hpp"
#include "solver/dem/fast/sweep.hpp"
#include "solver/dem/fast/wall_contacts.hpp"

namespace grainsweep::dem::fast {
namespace {

template <class Law>
constexpr Kernels compiled{width, sweep<Law>, advance<Law>, walls<Law>, search<Law>, refresh<Law>};

inline const Kernels& choose(const Needs& n) {
    using enum Needs::Cohesion;
    if (n.holds() && n.friction && !n.unequal) {
        if (n.cohesion == none) return compiled<Law<false, true, true, none, false, true>>;
        if (n.cohesion == lens) return compiled<Law<false, true, true, lens, false, true>>;
    }
    if (n.resting) {
        if (n.rolling) return compiled<Law<true, true, true, general, true, true>>;
        return compiled<Law<true, true, true, general, false, true>>;
    }
    if (n.rolling) return compiled<Law<true, true, true, general, true>>;
    if (n.friction && n.cohesion == none)
        return n.unequal ? compiled<Law<true, true, true, none>> : compiled<Law<false, false, true, none>>;
    if (n.friction && n.cohesion == lens && !n.unequal) return compiled<Law<false, true, true, lens>>;
    if (!n.friction && n.cohesion == none && !n.unequal) return compiled<Law<false, true, false, none>>;
    return compiled<Law<true, true, true, general>>;
}

}  // namespace
}  // namespace grainsweep::dem::fast
