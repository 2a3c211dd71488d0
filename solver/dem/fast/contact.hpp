// The Hertz-Mindlin contact with tangential history, branch-free over the lanes of a vector.
//
//   S_n = 2E* sqrt(R* d), S_t = 8G* sqrt(R* d), g = -2 sqrt(5/6) beta sqrt(S m*)   (e.g. Di Renzo & Di Maio 2004)
//   F_n = 4/3 E* sqrt(R* d) d - g_n v_n                                            not clipped
//   s += v_t dt, s -= (s.n) n;  S_t |s| > mu |F_n|: F_t = -mu |F_n| s/|s|, s := -F_t/S_t; else F_t = -S_t s - g_t v_t
//   cohesion is added to F_n afterwards; with net_limit Coulomb's limit sees the sum.
//   rolling: M += k_r (w_i - w_j)_t dt, |M| <= mu_r R* |F_n|, dashpot below the limit (solver/dem/laws/rolling.hpp)
//
// All numbers in the engine's units, where dt = 1. A law that is absent (Needs) is absent from the code.
// Included by the files of the instruction paths, after their lanes; internal linkage on purpose.
#pragma once

#include "solver/dem/fast/layout.hpp"

namespace grainsweep::dem::fast {
namespace {

using Cohesion = Needs::Cohesion;

/// Which laws a compiled kernel contains.
template <bool Unequal, bool Frozen, bool Friction, Cohesion Neck, bool Rolling = false, bool Held = false>
struct Law {
    static constexpr bool unequal = Unequal;
    static constexpr bool frozen = Frozen;
    static constexpr bool friction = Friction;
    static constexpr Cohesion neck = Neck;
    static constexpr bool cohesive = Neck != Cohesion::none;
    static constexpr bool rolling = Rolling;
    static constexpr bool held = Held;  ///< some particles are not advanced: Field::advanced lists the others
    static constexpr int histories = Rolling ? 6 : 3;
    static_assert(!Rolling || (Unequal && Friction), "rolling resistance is part of the general kernel only");
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

/// Kinematics of one contact per lane.
struct Meeting {
    M touching;
    V3 normal;
    F overlap;
    V3 velocity;     ///< v_i - v_j
    V3 surface;      ///< (R_i - d/2) w_i + (R_j - d/2) w_j
    F root_radius;   ///< sqrt(R*)
    F damping;       ///< -2 sqrt(5/6) beta sqrt(2 E* m*)
    F neck;          ///< cohesive force
    V3 turning;      ///< w_i - w_j; where rolling is resisted
    F turning_mass;  ///< sum of 1/(m R^2); likewise
};

/// History of a contact.
struct Memory {
    V3 tangential, rolling;
};
template <class Law>
GRAINSWEEP_LANES Memory load_memory(float* const* column, std::int64_t at) {
    Memory s{};
    s.tangential = {load(column[0] + at), load(column[1] + at), load(column[2] + at)};
    if constexpr (Law::rolling) s.rolling = {load(column[3] + at), load(column[4] + at), load(column[5] + at)};
    return s;
}
template <class Law>
GRAINSWEEP_LANES void store_memory(float* const* column, std::int64_t at, const Memory& s) {
    store(column[0] + at, s.tangential.x);
    store(column[1] + at, s.tangential.y);
    store(column[2] + at, s.tangential.z);
    if constexpr (Law::rolling) {
        store(column[3] + at, s.rolling.x);
        store(column[4] + at, s.rolling.y);
        store(column[5] + at, s.rolling.z);
    }
}

/// Moment on i, minus that on j, of the rolling spring and dashpot. `root`: sqrt(R* d); `limit`: the normal force.
GRAINSWEEP_LANES V3 resist_rolling(const Constants& c, const Meeting& m, F root, F limit, F history_step, V3& moment) {
    const V3 n = m.normal;
    const F radius = m.root_radius * m.root_radius;
    const F stiffness = broadcast(c.rolling) * root * radius * radius;
    const F twist = dot(m.turning, n);
    const V3 turning{fnma(twist, n.x, m.turning.x), fnma(twist, n.y, m.turning.y), fnma(twist, n.z, m.turning.z)};
    const F step = stiffness * history_step;
    V3 s{fma(turning.x, step, moment.x), fma(turning.y, step, moment.y), fma(turning.z, step, moment.z)};
    const F size = fma(s.x, s.x, fma(s.y, s.y, fma(s.z, s.z, broadcast(1e-37f))));
    F ratio = abs(limit) * radius * broadcast(c.rolling_friction) * inverse_root(size);
    const M yields = ratio < broadcast(1.0f);
    ratio = min(ratio, broadcast(1.0f));
    s = keep(m.touching, s * ratio);
    moment = s;
    const F dashpot = drop(yields, broadcast(c.rolling_damping) * sqrt(stiffness * inverse(m.turning_mass)));
    const F none = broadcast(0.0f);
    return keep(m.touching, {fnma(dashpot, turning.x, none - s.x), fnma(dashpot, turning.y, none - s.y),
                             fnma(dashpot, turning.z, none - s.z)});
}

/// Force on i and direction of the torques, n x (-F_t), and the rolling moment on i where it is resisted; zero in
/// lanes that do not touch. Updates the memory.
template <class Law>
GRAINSWEEP_LANES void respond(const Constants& c, const Meeting& m, F history_step, Memory& memory, V3& force, V3& turn,
                              [[maybe_unused]] V3& moment) {
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
    const V3 old = memory.tangential;
    V3 s{fma(slip.x, history_step, old.x), fma(slip.y, history_step, old.y), fma(slip.z, history_step, old.z)};
    const F along = dot(s, n);
    s = {fnma(along, n.x, s.x), fnma(along, n.y, s.y), fnma(along, n.z, s.z)};
    const F stiffness = root * broadcast(c.tangential);
    const F spring = stiffness * stiffness * fma(s.x, s.x, fma(s.y, s.y, fma(s.z, s.z, broadcast(1e-30f))));
    F ratio = abs(limit) * broadcast(c.friction) * inverse_root(spring);
    const M slides = ratio < broadcast(1.0f);
    ratio = min(ratio, broadcast(1.0f));
    s = keep(m.touching, s * ratio);
    memory.tangential = s;
    const F tangential_damping = drop(slides, damping * broadcast(c.damping_ratio));
    const V3 back{fma(stiffness, s.x, tangential_damping * slip.x), fma(stiffness, s.y, tangential_damping * slip.y),
                  fma(stiffness, s.z, tangential_damping * slip.z)};  // -F_t
    force = keep(m.touching, {fms(normal, n.x, back.x), fms(normal, n.y, back.y), fms(normal, n.z, back.z)});
    turn = keep(m.touching, cross(n, back));
    if constexpr (Law::rolling) moment = resist_rolling(c, m, root, limit, history_step, memory.rolling);
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
