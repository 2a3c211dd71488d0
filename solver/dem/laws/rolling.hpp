// Rolling resistance by an elastic-plastic spring and a dashpot.
//
//     dM = k_r w_t dt,  M += dM        w_t = (w_i - w_j) without its part along n
//     k_r = 2.25 k_n mu_r^2 R*^2,  k_n = 4/3 E* sqrt(R* d), or that of the linear law (linear.hpp)
//     moment on i  -M - 2 eta_r sqrt(I_r k_r) w_t,   1/I_r = sum of 1/(7/5 m R^2)
//     |M| <= mu_r R* N,  |moment| <= mu_r R* N          (sliding_limit.hpp; N: see mindlin.hpp)
//
// Ai, Chen, Rotter & Ooi (2011), Powder Technol. 206, 269, model C, where the dashpot is not limited below the limit of
// the spring (TangentialLimit::spring); stiffness after Iwashita & Oda (1998), J. Eng. Mech. 124, 285, as evaluated by
// LIGGGHTS 3.8 `rolling_friction epsd`. The memory is the moment, not the angle, so each increment uses k_r at the
// overlap of its time. M does not rotate with n; during a sticking contact n rotates by less than the angles that the
// spring allows. Twist about n is not resisted.
//
// mu_r is the tangent of the steepest slope on which a sphere stays at rest. There are two differences from LIGGGHTS,
// unless RollingLaw::epsd_liggghts is chosen. At a wall, LIGGGHTS uses (R - d/2)/(R - d) times w_i as relative
// rotation; here it is w_i. In its evaluation before the first step, LIGGGHTS has the moment of one step later.
#pragma once

#include "solver/dem/laws/sliding_limit.hpp"
#include "solver/dem/material.hpp"

namespace grainsweep::dem {

/// Rolling spring. `linear`: used with the linear normal law.
template <class Real, bool linear>
struct RollingSpring : LawTraits {
    using A = Arithmetic<Real>;
    static constexpr Aspect aspect = Aspect::rolling;
    static constexpr bool spin = true, rolls = true;
    static constexpr MemoryKind memory_kind{3, -1, moment};
    static constexpr int constants = 5;

    static bool wanted(const Material& m) { return m.rolling_friction > 0; }
    static bool suits(const Material& m) {
        const bool spring = m.rolling_law == RollingLaw::epsd || m.rolling_law == RollingLaw::epsd_liggghts;
        return linear == (m.normal_law == NormalLaw::linear) && (spring || !wanted(m));
    }
    static std::array<Quantity, constants> constants_of(const Material& m) {
        const double mu_r = m.rolling_friction;
        return {{{2.25 * mu_r * mu_r * (linear ? m.stiffness : 4.0 / 3.0 * effective_modulus(m)),
                  linear ? force_per_length : pressure},
                 {mu_r, number},
                 {2 * m.rolling_damping, {.inertia = -0.5}},
                 {m.rolling_law == RollingLaw::epsd_liggghts ? 0.5 : 0.0, number},
                 SlidingLimit<Real>::constant_of(m)}};
    }
    explicit RollingSpring(const double* c)
        : stiffness(A::number(c[0])),
          friction(A::number(c[1])),
          dashpot(A::number(c[2])),
          lever(A::number(c[3])),
          bound(c[4]) {}

    Real stiffness;  ///< 2.25 mu_r^2 4/3 E*, Pa; linear: 2.25 mu_r^2 k, N/m
    Real friction;   ///< mu_r
    Real dashpot;    ///< 2 eta_r
    Real lever;      ///< at walls the rotation is multiplied by 1 + lever d/(R - d)
    SlidingLimit<Real> bound;

    /// Returns k_r, N m.
    template <class T>
    [[nodiscard, gnu::always_inline]] Real spring(const T& t) const {
        if constexpr (linear) return stiffness * t.effective_radius * t.effective_radius;
        return stiffness * t.root * t.effective_radius * t.effective_radius;
    }

    /// Adds the moments. `advance` false: the spring's M does not change.
    template <bool advance, class T>
    [[gnu::always_inline]] void add(const T& t, Response<Real>& r, Real* moment_of_spring) const {
        const Real k = spring(t);
        auto turning = A::across(t.turning, t.normal);
        if constexpr (T::partner == Partner::wall)
            turning = A::scaled(turning, A::number(1) + lever * A::divided(t.overlap, t.effective_radius - t.overlap));
        auto m = A::vector(moment_of_spring);
        if constexpr (advance)
            m = A::add(m, t.time_step * k, turning);
        else
            m = A::add(m, (lever + lever) * t.time_step * k, turning);
        const auto limit = A::product(friction, t.effective_radius, bound.normal(r.seen));
        const auto cut = A::cut(m, t.template limit<advance>(limit, friction * t.effective_radius, r), bound.least);
        m = A::scaled(m, cut.scale);
        r.rolling = A::add(m, bound.damper(cut, dashpot * A::sqrt(t.rolling_inertia * k), turning), turning);
        if constexpr (advance) A::remember(moment_of_spring, t.kept(m));
    }

    template <class T>
    void add_springs(const T& t, Springs& s) const {
        s.rolling = spring(t);
        s.rolling_damper = dashpot * std::sqrt(t.rolling_inertia * s.rolling);
    }

    /// Returns the energy stored in the spring, J.
    template <class T>
    [[nodiscard]] Real energy(const T& t, const Real* moment_of_spring) const {
        const Real k = spring(t);
        const auto m = A::vector(moment_of_spring);
        return k > 0 ? 0.5 * geometry::dot(m, m) / k : 0.0;
    }
};

template <class Real>
using RollingResistance = RollingSpring<Real, false>;
template <class Real>
using LinearRolling = RollingSpring<Real, true>;

inline constexpr Resistance epsd_row{"epsd", "by an elastic-plastic spring with a dashpot", 1.4};
inline constexpr Resistance epsd_liggghts_row{"epsd_liggghts", "by the same with LIGGGHTS 3.8's angle at walls", 1.4};

}  // namespace grainsweep::dem
