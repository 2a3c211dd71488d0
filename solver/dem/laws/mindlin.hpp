// Tangential spring of constant stiffness at given overlap, limited by Coulomb friction.
//
//     s += v_t dt;  s -= (s.n) n;   k_t = S_t = 8 G* sqrt(R* d),   g_t = -2 sqrt(5/6) beta sqrt(S_t m*)
//     F_t = -k_t s - g_t v_t,  k_t |s| <= mu N,  |F_t| <= mu N          (sliding_limit.hpp)
//
// Mindlin (1949), J. Appl. Mech. 16, 259, no-slip stiffness in total form. N is the normal force that friction sees
// (Response::seen), where it repels: the contact force alone or the net force, as set by the laws before this one
// (Material::friction_limit).
#pragma once

#include "solver/dem/laws/sliding_limit.hpp"
#include "solver/dem/material.hpp"

namespace grainsweep::dem {

template <class Real>
struct Mindlin : LawTraits {
    using A = Arithmetic<Real>;
    static constexpr Aspect aspect = Aspect::sliding;
    static constexpr bool spin = true;
    static constexpr MemoryKind memory_kind{3, -1, length};
    static constexpr int constants = 5;

    static bool wanted(const Material& m) { return m.friction > 0; }
    static bool suits(const Material& m) { return m.normal_law == NormalLaw::hertz; }
    /// Returns the constants. Without friction the dashpot is 0, because a spring that is not displaced is not cut.
    static std::array<Quantity, constants> constants_of(const Material& m) {
        const double modulus = 8 * effective_shear_modulus(m), on = m.friction > 0 ? 1 : 0;
        return {{{modulus, pressure},
                 {on * damping_factor(m.restitution) * std::sqrt(modulus), root_of_pressure},
                 {on * std::sqrt(modulus / (2 * effective_modulus(m))), number},
                 {m.friction, number},
                 SlidingLimit<Real>::constant_of(m)}};
    }
    explicit Mindlin(const double* c)
        : stiffness(A::number(c[0])), damping{A::damping(c[1], c[2])}, friction(A::number(c[3])), coulomb(c[4]) {}

    Real stiffness;               ///< 8 G*, Pa
    typename A::Damping damping;  ///< -2 sqrt(5/6) beta sqrt(8 G*), sqrt(Pa)
    Real friction;                ///< mu
    SlidingLimit<Real> coulomb;

    /// Adds the tangential force. `advance` false: the displacement s does not change.
    template <bool advance, class T>
    [[gnu::always_inline]] void add(const T& t, Response<Real>& r, Real* displacement) const {
        auto s = A::vector(displacement);
        if constexpr (advance) s = A::across(A::add(s, t.time_step, t.slip), t.normal);
        const Real k = stiffness * t.root;
        const auto spring =
            A::cut(k, s, t.template limit<advance>(friction * coulomb.normal(r.seen), friction, r), coulomb.least);
        const Real whole = t.damped_beside(damping, r.damping), damper = coulomb.damper(spring, whole, t.slip);
        r.slides = A::either(spring.exceeds, damper < whole);
        r.resistance = A::spring(k, spring.scale, s, damper, t.slip);
        if constexpr (advance) A::remember(displacement, t.kept(A::scaled(s, spring.scale)));
    }

    template <class T>
    void add_springs(const T& t, Springs& s) const {
        if (!(friction > 0)) return;
        s.tangential = stiffness * t.root;
        s.tangential_damper = t.damped(damping);
    }

    /// Returns the energy stored in the tangential displacement, J.
    template <class T>
    [[nodiscard]] Real energy(const T& t, const Real* displacement) const {
        const auto s = A::vector(displacement);
        return 0.5 * stiffness * t.root * geometry::dot(s, s);
    }
};

}  // namespace grainsweep::dem
