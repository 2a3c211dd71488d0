// Tangential spring of constant stiffness at given overlap, limited by Coulomb friction.
//
//     s += v_t dt;  s -= (s.n) n;   k_t = S_t = 8 G* sqrt(R* d),   g_t = -2 sqrt(5/6) beta sqrt(S_t m*)
//     sticking  k_t |s| <= mu |F_n|:  F_t = -k_t s - g_t v_t          (the sum is not limited)
//     sliding   otherwise:            F_t = -mu |F_n| s/|s|,  s := -F_t/k_t   (no tangential damping)
//
// Mindlin (1949), J. Appl. Mech. 16, 259, no-slip stiffness in total form. F_n is the normal force of the
// laws before this one: placed before a cohesion law friction sees the contact force alone, after it the net.
#pragma once

#include "solver/dem/laws/touch.hpp"
#include "solver/particles/needs.hpp"

#include <cmath>

namespace grainsweep::dem {

struct Mindlin {
    static constexpr particles::Needs needs{
        .spin = true, .tangential_history = true, .sizes = false, .frozen = false, .rolling_history = false};

    double stiffness = 0;  ///< 8 G*, Pa
    double damping = 0;    ///< -2 sqrt(5/6) beta sqrt(8 G*), sqrt(Pa)
    double friction = 0;   ///< mu
    double time_step = 0;  ///< s

    /// `advance` false: forces only, the displacement s stays as it is.
    template <bool advance, Partner partner>
    void add(const Touch<partner>& t, Response& r, Vec3& s) const {
        using namespace geometry;
        if constexpr (advance) {
            s += time_step * t.slip;
            s -= dot(s, t.normal) * t.normal;
        }
        const double k = stiffness * t.root;
        const double limit = friction * std::abs(r.normal);
        const double spring = k * std::sqrt(dot(s, s));
        // Both answers are computed and one is chosen: which of them holds is hard to predict.
        const bool slides = spring > limit;
        const double scale = slides ? limit / spring : 1.0;
        const double viscosity = slides ? 0.0 : damping * t.damping_root;
        r.tangential += (-k * scale) * s - viscosity * t.slip;
        if constexpr (advance) s = scale * s;
    }

    /// Stored in the tangential displacement, J.
    template <Partner partner>
    [[nodiscard]] double energy(const Touch<partner>& t, const Vec3& s) const {
        return 0.5 * stiffness * t.root * geometry::dot(s, s);
    }
};

}  // namespace grainsweep::dem
