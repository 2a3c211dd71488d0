// The Hertz-Mindlin contact with tangential history, branch-free over the lanes of a vector.
//
//   S_n = 2E* sqrt(R* d), S_t = 8G* sqrt(R* d), g = -2 sqrt(5/6) beta sqrt(S m*)   (e.g. Di Renzo & Di Maio 2004)
//   F_n = 4/3 E* sqrt(R* d) d - g_n v_n                                            not clipped
//   s += v_t dt, s -= (s.n) n;  S_t |s| > mu |F_n|: F_t = -mu |F_n| s/|s|, s := -F_t/S_t; else F_t = -S_t s - g_t v_t
//   cohesion is added to F_n afterwards; with net_limit Coulomb's limit sees the sum.
//
// All numbers in the engine's units, where dt = 1. A law that is absent (Needs) is absent from the code.
// Included by the files of the instruction paths, after their lanes; internal linkage on purpose.
#pragma once

#include "solver/dem/fast/layout.hpp"

namespace grainsweep::dem::fast {
namespace {

using Cohesion = Needs::Cohesion;

/// Which laws a compiled kernel contains.
template <bool Unequal, bool Frozen, bool Friction, Cohesion Neck>
struct Law {
    static constexpr bool unequal = Unequal;
    static constexpr bool frozen = Frozen;
    static constexpr bool friction = Friction;
    static constexpr Cohesion neck = Neck;
    static constexpr bool cohesive = Neck != Cohesion::none;
};

// One Newton step brings the processor's estimate to the end of single precision.
GRAINSWEEP_LANES F inverse_root(F a) {
    const F y = approximate_rsqrt(a);
    const F residue = fnma(a * y, y, broadcast(1.0f));
    return fma(y * broadcast(0.5f), residue, y);
}
GRAINSWEEP_LANES F inverse(F a) {
    const F y = approximate_rcp(a);
    return y * fnma(a, y, broadcast(2.0f));
}

struct V3 {
    F x, y, z;
};
GRAINSWEEP_LANES F dot(V3 a, V3 b) {
    return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z));
}
/// c + a x b
GRAINSWEEP_LANES V3 add_cross(V3 c, V3 a, V3 b) {
    return {fnma(a.z, b.y, fma(a.y, b.z, c.x)), fnma(a.x, b.z, fma(a.z, b.x, c.y)), fnma(a.y, b.x, fma(a.x, b.y, c.z))};
}
GRAINSWEEP_LANES V3 cross(V3 a, V3 b) {
    return {fms(a.y, b.z, a.z * b.y), fms(a.z, b.x, a.x * b.z), fms(a.x, b.y, a.y * b.x)};
}
GRAINSWEEP_LANES V3 keep(M m, V3 a) {
    return {keep(m, a.x), keep(m, a.y), keep(m, a.z)};
}
GRAINSWEEP_LANES V3 operator*(V3 a, F b) {
    return {a.x * b, a.y * b, a.z * b};
}

/// What geometry and motion say about one contact per lane.
struct Meeting {
    M touching;
    V3 normal;
    F overlap;
    V3 velocity;    ///< v_i - v_j
    V3 surface;     ///< (R_i - d/2) w_i + (R_j - d/2) w_j
    F root_radius;  ///< sqrt(R*)
    F damping;      ///< -2 sqrt(5/6) beta sqrt(2 E* m*)
    F neck;         ///< cohesive force
};

/// Force on i and direction of the torques, n x (-F_t); zero in lanes that do not touch. Updates the history.
template <class Law>
GRAINSWEEP_LANES void respond(const Constants& c, const Meeting& m, F history_step, V3& history, V3& force, V3& turn) {
    const V3 n = m.normal;
    const F vn = dot(m.velocity, n);
    // sqrt(R* d) and its root: one by the divider, one by multiplications, so that both units work
    const F d = max(m.overlap, broadcast(1e-30f));
    const F root = m.root_radius * sqrt(d);
    const F damping = (root * inverse_root(root)) * m.damping;
    F normal = fnma(damping, vn, root * broadcast(c.normal) * d);
    F limit = normal;
    if constexpr (Law::cohesive) {
        const F attracted = normal - m.neck;
        if constexpr (Law::neck == Cohesion::general) limit = fnma(broadcast(c.net_limit), m.neck, normal);
        normal = attracted;
    }
    if constexpr (!Law::friction) {
        force = keep(m.touching, n * normal);
        turn = {broadcast(0.0f), broadcast(0.0f), broadcast(0.0f)};
        return;
    }
    // tangential velocity at the contact: v - v_n n - surface x n
    const V3 slip = add_cross({fnma(vn, n.x, m.velocity.x), fnma(vn, n.y, m.velocity.y), fnma(vn, n.z, m.velocity.z)},
                              n, m.surface);
    V3 s{fma(slip.x, history_step, history.x), fma(slip.y, history_step, history.y),
         fma(slip.z, history_step, history.z)};
    const F along = dot(s, n);
    s = {fnma(along, n.x, s.x), fnma(along, n.y, s.y), fnma(along, n.z, s.z)};
    const F stiffness = root * broadcast(c.tangential);
    const F spring = stiffness * stiffness * fma(s.x, s.x, fma(s.y, s.y, fma(s.z, s.z, broadcast(1e-30f))));
    F ratio = abs(limit) * broadcast(c.friction) * inverse_root(spring);
    const M slides = ratio < broadcast(1.0f);
    ratio = min(ratio, broadcast(1.0f));
    s = keep(m.touching, s * ratio);
    history = s;
    const F tangential_damping = drop(slides, damping * broadcast(c.damping_ratio));
    const V3 back{fma(stiffness, s.x, tangential_damping * slip.x), fma(stiffness, s.y, tangential_damping * slip.y),
                  fma(stiffness, s.z, tangential_damping * slip.z)};  // -F_t
    force = keep(m.touching, {fms(normal, n.x, back.x), fms(normal, n.y, back.y), fms(normal, n.z, back.z)});
    turn = keep(m.touching, cross(n, back));
}

/// Cohesive force of a pair; `closeness` is (R_i+R_j)^2 - r^2.
template <class Law>
GRAINSWEEP_LANES F pair_neck(const Constants& c, F closeness, F inverse_distance, F overlap, F difference,
                             F root_radius) {
    F lens = closeness * broadcast(c.neck_lens);
    if constexpr (Law::unequal)
        lens = lens * fnma(difference * difference, inverse_distance * inverse_distance, broadcast(1.0f));
    if constexpr (Law::neck == Cohesion::lens) return lens;
    const F linear = root_radius * root_radius * overlap;
    return fma(broadcast(c.neck_linear), linear, fma(broadcast(c.neck_square), overlap * overlap, lens));
}

}  // namespace
}  // namespace grainsweep::dem::fast
