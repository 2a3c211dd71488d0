// A contact: laws applied one after the other. It needs what any of them needs.
#pragma once

#include "solver/dem/laws/touch.hpp"
#include "solver/particles/needs.hpp"
#include "solver/particles/pair_memory.hpp"

#include <tuple>
#include <type_traits>

namespace grainsweep::dem {

/// The history a pair has under these needs.
template <particles::Needs needs>
using MemoryFor = std::conditional_t<needs.rolling_history, particles::TangentialAndRolling,
                                     std::conditional_t<needs.tangential_history, Vec3, NoMemory>>;

/// The part of it that belongs to a law.
template <class Law, class Memory>
[[nodiscard]] auto& part_of(Memory& memory) {
    if constexpr (!std::is_same_v<std::remove_const_t<Memory>, particles::TangentialAndRolling>)
        return memory;
    else if constexpr (Law::needs.rolling_history)
        return memory.rolling;
    else
        return memory.tangential;
}

/// A law may declare that the history of a pair outlives a separation: until the neighbour list is rebuilt, and beyond
/// if the pair touches again at that moment. None here does.
template <class Law>
inline constexpr bool remembers_separation = requires {
    requires Law::remembers_separation;
};

template <class... Laws>
struct Contact {
    static constexpr particles::Needs needs = (particles::Needs{} | ... | Laws::needs);
    static constexpr bool remembers_separation = (dem::remembers_separation<Laws> || ...);
    using Memory = MemoryFor<needs>;

    std::tuple<Laws...> laws;

    /// Force of a touching pair; `advance` true: memories move on by one time step.
    template <bool advance, Partner partner>
    [[nodiscard]] Response respond(const Touch<partner>& t, Memory& memory) const {
        Response r;
        std::apply(
            [&](const auto&... law) {
                (law.template add<advance>(t, r, part_of<std::remove_cvref_t<decltype(law)>>(memory)), ...);
            },
            laws);
        return r;
    }

    /// Energy stored in the pair, J.
    template <Partner partner>
    [[nodiscard]] double energy(const Touch<partner>& t, const Memory& memory) const {
        return std::apply(
            [&](const auto&... law) {
                return (0.0 + ... + law.energy(t, part_of<std::remove_cvref_t<decltype(law)>>(memory)));
            },
            laws);
    }
};

}  // namespace grainsweep::dem
