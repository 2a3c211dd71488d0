// Linear spring and dashpot, in the normal and in the tangential direction.
//
//     F_n = k d - g v_n,   g = -2 beta sqrt(k m*),   beta = ln e / sqrt(ln^2 e + pi^2) <= 0
//
// k is given. An impact is half a period of a damped harmonic oscillator: at any speed it lasts t_c = pi/sqrt(k/m* -
// (g/(2 m*))^2) and has the restitution e = exp(-g t_c/(2 m*)). The force is not clipped: near its end a damped contact
// attracts. Friction sees F_n as in hertz.hpp.
//
//     s += v_t dt;  s -= (s.n) n;   k_t = r k,   g_t = q g
//     F_t = -k_t s - g_t v_t,  k_t |s| <= mu N,  |F_t| <= mu N        (sliding_limit.hpp; N: see mindlin.hpp)
//
// A freely rotating sphere has the effective mass 2/7 m* at the tangential spring. At r = 2/7 both springs have the
// same period, and with q = r also the same restitution.
//
// Cundall & Strack (1979), Geotechnique 29, 47; ratios after Schaefer, Dippel & Wolf (1996), J. Phys. I France 6, 5.
#pragma once

#include "solver/dem/laws/sliding_limit.hpp"
#include "solver/dem/material.hpp"

namespace grainsweep::dem {

template <class Real>
struct Linear : LawTraits {
    using A = Arithmetic<Real>;
    static constexpr Aspect aspect = Aspect::normal;
    static constexpr int constants = 3;

    static bool wanted(const Material& m) { return m.normal_law == NormalLaw::linear; }
    static bool suits(const Material& m) { return wanted(m); }
    static std::array<Quantity, constants> constants_of(const Material& m) {
        return {{{m.stiffness, force_per_length},
                 {-2 * damping_ratio(m.restitution) * std::sqrt(m.stiffness), root_of_force_per_length},
                 {-pull_back_share(m), number}}};
    }
    explicit Linear(const double* c)
        : stiffness(A::number(c[0])), damping{A::damping(c[1])}, pull_back(A::number(c[2])) {}

    Real stiffness;               ///< k, N/m
    typename A::Damping damping;  ///< -2 beta sqrt(k), sqrt(N/m)
    Real pull_back;               ///< minus pull_back_share

    template <bool advance, class T>
    [[gnu::always_inline]] void add(const T& t, Response<Real>& r, Real*) const {
        r.elastic = stiffness * t.overlap;
        r.damping = t.damped_by_mass(damping);
        r.normal = A::fnma(r.damping, t.normal_velocity, r.elastic);
        r.seen = A::fnma(pull_back * r.damping, A::smaller(t.normal_velocity, A::number(0)), r.normal);
    }

    template <class T>
    void add_springs(const T& t, Springs& s) const {
        s.normal = stiffness;
        s.normal_damper = t.damped_by_mass(damping);
    }

    /// Returns the energy stored in the overlap, J.
    template <class T>
    [[nodiscard]] Real energy(const T& t, const Real*) const {
        return 0.5 * stiffness * t.overlap * t.overlap;
    }
};

template <class Real>
struct LinearSliding : LawTraits {
    using A = Arithmetic<Real>;
    static constexpr Aspect aspect = Aspect::sliding;
    static constexpr bool spin = true;
    static constexpr MemoryKind memory_kind{3, -1, length};
    static constexpr int constants = 4;

    static bool wanted(const Material& m) { return m.friction > 0; }
    static bool suits(const Material& m) { return m.normal_law == NormalLaw::linear; }
    /// Returns the constants. Without friction the dashpot is 0, because a spring that is not displaced is not cut.
    static std::array<Quantity, constants> constants_of(const Material& m) {
        return {{{m.tangential_ratio * m.stiffness, force_per_length},
                 {m.friction > 0 ? m.tangential_damping.value_or(m.tangential_ratio) : 0.0, number},
                 {m.friction, number},
                 SlidingLimit<Real>::constant_of(m)}};
    }
    explicit LinearSliding(const double* c)
        : stiffness(A::number(c[0])), over_normal(A::number(c[1])), friction(A::number(c[2])), coulomb(c[3]) {}

    Real stiffness;    ///< r k, N/m
    Real over_normal;  ///< q
    Real friction;     ///< mu
    SlidingLimit<Real> coulomb;

    /// Adds the tangential force. `advance` false: the displacement s does not change.
    template <bool advance, class T>
    [[gnu::always_inline]] void add(const T& t, Response<Real>& r, Real* displacement) const {
        auto s = A::vector(displacement);
        if constexpr (advance) s = A::across(A::add(s, t.time_step, t.slip), t.normal);
        const auto spring = A::cut(
            stiffness, s, t.template limit<advance>(friction * coulomb.normal(r.seen), friction, r), coulomb.least);
        const Real whole = over_normal * r.damping, damper = coulomb.damper(spring, whole, t.slip);
        r.slides = A::either(spring.exceeds, damper < whole);
        r.resistance = A::spring(stiffness, spring.scale, s, damper, t.slip);
        if constexpr (advance) A::remember(displacement, t.kept(A::scaled(s, spring.scale)));
    }

    template <class T>
    void add_springs(const T&, Springs& s) const {
        if (!(friction > 0)) return;
        s.tangential = stiffness;
        s.tangential_damper = over_normal * s.normal_damper;
    }

    /// Returns the energy stored in the tangential displacement, J.
    template <class T>
    [[nodiscard]] Real energy(const T&, const Real* displacement) const {
        const auto s = A::vector(displacement);
        return 0.5 * stiffness * geometry::dot(s, s);
    }
};

}  // namespace grainsweep::dem
