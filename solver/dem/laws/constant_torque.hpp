// Rolling resistance by a torque of constant size against the relative rotation.
//
//     T = mu_r k_n d R* w/|w|,   w = w_i - w_j (at a wall w_i),   T := T - (T.n) n,   moment on i  -T, on j  T
//     k_n d = 4/3 E* sqrt(R* d) d or that of the linear law, the elastic part of F_n
//
// Zhou, Wang, Yang & Xu (1999), Physica A 269, 536, eq. 7 (model A of Ai, Chen, Rotter & Ooi (2011), Powder Technol.
// 206, 269), as evaluated by LIGGGHTS 3.8 `rolling_friction cdt`: the torque is divided by the whole |w|, including
// twist, before its component along n is removed; F_n is without damping. It has no memory and no threshold, so a
// particle at rest oscillates around w = 0 within mu_r k_n d R* dt/I.
#pragma once

#include "solver/dem/laws/touch.hpp"
#include "solver/dem/material.hpp"

namespace grainsweep::dem {

template <class Real>
struct ConstantTorque : LawTraits {
    using A = Arithmetic<Real>;
    static constexpr Aspect aspect = Aspect::rolling;
    static constexpr bool spin = true, rolls = true;
    static constexpr int constants = 1;

    static bool wanted(const Material& m) { return m.rolling_friction > 0; }
    static bool suits(const Material& m) { return m.rolling_law == RollingLaw::cdt || !wanted(m); }
    static std::array<Quantity, constants> constants_of(const Material& m) { return {{{m.rolling_friction, number}}}; }
    explicit ConstantTorque(const double* c) : friction(A::number(c[0])) {}

    Real friction;  ///< mu_r

    template <bool advance, class T>
    [[gnu::always_inline]] void add(const T& t, Response<Real>& r, Real*) const {
        const Real size = A::product(friction, t.effective_radius, r.elastic);
        r.rolling = A::across(A::directed(size, t.turning), t.normal);
    }

    /// Returns 0: no energy is stored.
    template <class T>
    [[nodiscard]] Real energy(const T&, const Real*) const {
        return Real{};
    }
};

inline constexpr Resistance cdt_row{"cdt", "by a constant torque"};

}  // namespace grainsweep::dem
