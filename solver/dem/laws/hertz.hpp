// Normal force of two elastic spheres with damping of constant restitution.
//
//     F_n = k_n d - g_n v_n,   k_n = 4/3 E* sqrt(R* d),   g_n = -2 sqrt(5/6) beta sqrt(S_n m*),
//     S_n = 2 E* sqrt(R* d),   beta = ln e / sqrt(ln^2 e + pi^2) <= 0
//
// Hertz (1882); damping after Tsuji, Tanaka & Ishida (1992), Powder Technol. 71, 239, in the form of Antypov &
// Elliott (2011), EPL 94, 50004. Not clipped: near its end a damped contact attracts.
#pragma once

#include "solver/dem/laws/touch.hpp"
#include "solver/particles/needs.hpp"

namespace grainsweep::dem {

struct Hertz {
    static constexpr particles::Needs needs{};

    double stiffness = 0;  ///< 4/3 E*, Pa
    double damping = 0;    ///< -2 sqrt(5/6) beta sqrt(2 E*), sqrt(Pa)

    template <bool advance, Partner partner, class Memory>
    void add(const Touch<partner>& t, Response& r, Memory&) const {
        r.normal += stiffness * t.root * t.overlap - damping * t.damping_root * t.normal_velocity;
    }

    /// Stored in the overlap, J.
    template <Partner partner, class Memory>
    [[nodiscard]] double energy(const Touch<partner>& t, const Memory&) const {
        return 0.4 * stiffness * t.root * t.overlap * t.overlap;
    }
};

}  // namespace grainsweep::dem
