// Kernels of every compiled combination of laws, and the choice among them.
// The files of the instruction paths include this file; it has internal linkage on purpose.
#pragma once

#include "solver/dem/fast/clump_lanes.hpp"
#include "solver/dem/fast/search.hpp"
#include "solver/dem/fast/sweep.hpp"
#include "solver/dem/fast/wall_contacts.hpp"
#include "solver/dem/fast/wall_pieces.hpp"

namespace grainsweep::dem::fast {
namespace {

template <class K, bool several = false>
constexpr Kernels compiled{width,
                           sweep<K, several>,
                           advance<K>,
                           walls<K>,
                           mark_touching,
                           find_pieces,
                           search<K::unequal>,
                           refresh<K::unequal>,
                           step_clumps<K::unequal>,
                           find_mobility};
template <class K>
GRAINSWEEP_LANES const Kernels& holding(const Needs& n) {
    return n.several ? compiled<K, true> : compiled<K>;
}

template <class Combination>
GRAINSWEEP_LANES const Kernels& kernels_for(const Needs& n) {
    if constexpr (Combination::columns == Columns::any) {
        return holding<Kernel<Combination, true, true>>(n);
    } else {
        if constexpr (Combination::columns == Columns::sizes)
            if (n.unequal) return holding<Kernel<Combination, true, true>>(n);
        if (n.holds()) return holding<Kernel<Combination, false, true>>(n);
        return compiled<Kernel<Combination, false, false>>;
    }
}

template <class... Combinations>
GRAINSWEEP_LANES const Kernels& choose(CombinationList<Combinations...>, const Needs& n) {
    const Kernels* chosen = nullptr;
    std::int32_t k = 0;
    ((k++ == n.combination ? void(chosen = &kernels_for<Combinations>(n)) : void()), ...);
    return *chosen;
}

}  // namespace
}  // namespace grainsweep::dem::fast
