// A contact: laws that speak one after the other. What one of them needs, the contact needs.
#pragma once

#include "solver/dem/laws/touch.hpp"
#include "solver/particles/needs.hpp"

#include <tuple>
#include <type_traits>

namespace grainsweep::dem {

/// A law may say that the memory of a pair outlives a separation: until the neighbour list is rebuilt, and beyond if
/// the pair touches again at that moment. Ours do not.
template <class Law>
inline constexpr bool remembers_separation = requires {
    requires Law::remembers_separation;
};

template <class... Laws>
struct Contact {
    static constexpr particles::Needs needs = (particles::Needs{} | ... | Laws::needs);
    static constexpr bool remembers_separation = (dem::remembers_separation<Laws> || ...);
    using Memory = std::conditional_t<needs.tangential_history, Vec3, NoMemory>;

    std::tuple<Laws...> laws;

    /// Force of a touching pair; `advance` true: memories move on by one time step.
    template <bool advance, Partner partner>
    [[nodiscard]] Response respond(const Touch<partner>& t, Memory& memory) const {
        Response r;
        std::apply([&](const auto&... law) { (law.template add<advance>(t, r, memory), ...); }, laws);
        return r;
    }

    /// Energy stored in the pair, J.
    template <Partner partner>
    [[nodiscard]] double energy(const Touch<partner>& t, const Memory& memory) const {
        return std::apply([&](const auto&... law) { return (0.0 + ... + law.energy(t, memory)); }, laws);
    }
};

}  // namespace grainsweep::dem
