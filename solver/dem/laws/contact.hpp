// Contact: laws applied one after the other. It needs the inputs of all laws, and its memory is their memories in
// order.
#pragma once

#include "solver/dem/laws/touch.hpp"
#include "solver/dem/material.hpp"

#include <algorithm>
#include <type_traits>
#include <vector>

namespace grainsweep::dem {

/// Returns whether a law for this aspect is needed by the material (compiled.cpp).
[[nodiscard]] bool wants(const Material& material, Aspect aspect);

template <class Real, template <class> class... Laws>
struct Contact : Laws<Real>... {
    static constexpr bool spin = (Laws<Real>::spin || ...);
    static constexpr bool rolls = (Laws<Real>::rolls || ...);
    static constexpr bool reaches = (Laws<Real>::reaches || ...);
    static constexpr bool acts_apart = (Laws<Real>::acts_apart || ...);
    static constexpr bool remembers_separation = (Laws<Real>::remembers_separation || ...);
    /// Number of components of its memory.
    static constexpr int memories = (0 + ... + Laws<Real>::memory_kind.components);
    static constexpr bool remembers = memories > 0;
    static constexpr int constants = (0 + ... + Laws<Real>::constants);
    using Memory = std::array<Real, static_cast<std::size_t>(memories)>;

    /// Takes the constants of all laws, in order.
    explicit Contact(const double* c) : Laws<Real>(c + constants_before<Laws<Real>>())... {}

    /// Decides, for laws that reach beyond touch, whether a near pair is a contact, and computes its radius. Called
    /// once before the laws are applied.
    template <class T>
    [[gnu::always_inline]] void begin(T& t, const Real* memory) const {
        (Laws<Real>::begin(t, memory + memory_before<Laws<Real>>()), ...);
    }
    /// Returns the largest gap of a lasting contact, m.
    [[nodiscard]] static double beyond(const Material& m, double effective_radius) {
        double largest = 0;
        ((largest = std::max(largest, Laws<Real>::beyond(m, effective_radius))), ...);
        return largest;
    }

    /// Returns the forces of a touching pair. `advance` true: memories advance by one time step.
    template <bool advance, class T>
    [[nodiscard, gnu::always_inline]] Response<Real> respond(const T& t, Real* memory) const {
        Response<Real> r;
        (Laws<Real>::template add<advance>(t, r, memory + memory_before<Laws<Real>>()), ...);
        return r;
    }

    /// Returns the springs and dampers of the pair.
    template <class T>
    [[nodiscard]] Springs springs(const T& t) const {
        Springs s;
        (Laws<Real>::add_springs(t, s), ...);
        return s;
    }

    /// Returns the energy stored in the pair, J.
    template <class T>
    [[nodiscard]] Real energy(const T& t, const Real* memory) const {
        return (0.0 + ... + Laws<Real>::energy(t, memory + memory_before<Laws<Real>>()));
    }

    /// Returns whether it can compute a material: all laws suit the material, and no law that it needs is missing.
    [[nodiscard]] static bool covers(const Material& m) {
        bool result = (Laws<Real>::suits(m) && ...);
        for (const Aspect a : {Aspect::normal, Aspect::cohesion, Aspect::sliding, Aspect::rolling})
            result = result && (((Laws<Real>::aspect == a) || ...) || !wants(m, a));
        return result;
    }
    [[nodiscard]] static std::vector<Quantity> constants_of(const Material& material) {
        std::vector<Quantity> all;
        const auto append = [&](const auto& some) { all.insert(all.end(), some.begin(), some.end()); };
        (append(Laws<Real>::constants_of(material)), ...);
        return all;
    }
    /// Returns the values of the constants in SI.
    [[nodiscard]] static std::vector<double> values_of(const Material& material) {
        std::vector<double> values;
        for (const Quantity& q : constants_of(material)) values.push_back(q.value);
        return values;
    }
    /// Returns the contact of a material, in SI.
    [[nodiscard]] static Contact of(const Material& material) { return Contact(values_of(material).data()); }
    /// Returns the kind of every component of the memory.
    [[nodiscard]] static std::vector<MemoryKind> memory_kinds() {
        std::vector<MemoryKind> all;
        (all.insert(all.end(), Laws<Real>::memory_kind.components, Laws<Real>::memory_kind), ...);
        return all;
    }

private:
    template <class Law>
    static constexpr int constants_before() {
        int sum = 0;
        bool found = false;
        ((found = found || std::is_same_v<Law, Laws<Real>>, sum += found ? 0 : Laws<Real>::constants), ...);
        return sum;
    }
    template <class Law>
    static constexpr int memory_before() {
        int sum = 0;
        bool found = false;
        ((found = found || std::is_same_v<Law, Laws<Real>>, sum += found ? 0 : Laws<Real>::memory_kind.components),
         ...);
        return sum;
    }
};

}  // namespace grainsweep::dem
