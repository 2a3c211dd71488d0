// Normal force of two elastic spheres with damping of constant restitution.
//
//     F_n = k_n d - g_n v_n,   k_n = 4/3 E* sqrt(R* d),   g_n = -2 sqrt(5/6) beta sqrt(S_n m*),
//     S_n = 2 E* sqrt(R* d),   beta = ln e / sqrt(ln^2 e + pi^2) <= 0
//
// Hertz (1882); damping after Tsuji, Tanaka & Ishida (1992), Powder Technol. 71, 239, in the form of Antypov &
// Elliott (2011), EPL 94, 50004. The force is not clipped: near its end a damped contact attracts.
//
// Friction sees F_n - a g_n max(-v_n, 0), where that repels. The share a of the damper in approach has the impulse by
// which the contact attracts at its end (pull_back_share), so that an impact in gross sliding has a tangential impulse
// of mu times the normal one, at any restitution, and never a tangential force above mu F_n. Where the spring alone is
// limited (Material::tangential_limit), friction sees F_n.
#pragma once

#include "solver/dem/laws/touch.hpp"
#include "solver/dem/material.hpp"

namespace grainsweep::dem {

template <class Real>
struct Hertz : LawTraits {
    using A = Arithmetic<Real>;
    static constexpr Aspect aspect = Aspect::normal;
    static constexpr int constants = 3;

    static bool wanted(const Material& m) { return m.normal_law == NormalLaw::hertz; }
    static bool suits(const Material& m) { return wanted(m); }
    static std::array<Quantity, constants> constants_of(const Material& m) {
        const double modulus = effective_modulus(m);
        return {{{4.0 / 3.0 * modulus, pressure},
                 {damping_factor(m.restitution) * std::sqrt(2 * modulus), root_of_pressure},
                 {-pull_back_share(m), number}}};
    }
    explicit Hertz(const double* c)
        : stiffness(A::number(c[0])), damping{A::damping(c[1])}, pull_back(A::number(c[2])) {}

    Real stiffness;               ///< 4/3 E*, Pa
    typename A::Damping damping;  ///< -2 sqrt(5/6) beta sqrt(2 E*), sqrt(Pa)
    Real pull_back;               ///< minus pull_back_share

    template <bool advance, class T>
    [[gnu::always_inline]] void add(const T& t, Response<Real>& r, Real*) const {
        r.elastic = stiffness * t.root * t.overlap;
        r.damping = t.damped(damping);
        r.normal = A::fnma(r.damping, t.normal_velocity, r.elastic);
        r.seen = A::fnma(pull_back * r.damping, A::smaller(t.normal_velocity, A::number(0)), r.normal);
    }

    template <class T>
    void add_springs(const T& t, Springs& s) const {
        s.normal = 1.5 * stiffness * t.root;
        s.normal_damper = t.damped(damping);
    }

    /// Returns the energy stored in the overlap, J.
    template <class T>
    [[nodiscard]] Real energy(const T& t, const Real*) const {
        return 0.4 * stiffness * t.root * t.overlap * t.overlap;
    }
};

}  // namespace grainsweep::dem
