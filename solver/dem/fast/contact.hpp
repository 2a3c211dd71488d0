// Contacts in the lanes of a vector, without branches: their kinematics, and the laws (solver/dem/laws). All numbers
// are in the engine's units, where dt = 1. Absent laws generate no code. The files of the instruction paths include
// this file after their lanes; it has internal linkage on purpose.
#pragma once

#include "solver/dem/fast/lane_arithmetic.hpp"

// Makes each phase a function of its own, so that the compiler can schedule its loops and a sampling profiler shows the
// phases.
#define GRAINSWEEP_PHASE __attribute__((noinline))

namespace grainsweep::dem::fast {
namespace {

/// Traits of a compiled kernel.
template <class Combination, bool Unequal, bool Holds>
struct Kernel {
    using Laws = typename Combination::template Contact<F>;
    static constexpr bool unequal = Unequal;
    /// Whether some particles may be held (frozen or at rest).
    static constexpr bool holds = Holds;
    static constexpr bool spin = Laws::spin;
    static constexpr bool rolls = Laws::rolls;
    static constexpr int histories = Laws::memories;
    static constexpr bool reaches = Laws::reaches;
    static constexpr bool acts_apart = Laws::acts_apart;
};

/// Returns the lanes that may be contacts, before laws that reach beyond touch decide.
template <class Kernel>
GRAINSWEEP_LANES M may_touch(F depth) {
    return broadcast(Kernel::reaches ? -1e30f : 0.0f) < depth;
}

/// Kinematics of one contact per lane, with the names of dem::Touch.
template <class Kernel, Partner of>
struct Meeting {
    static constexpr Partner partner = of;
    M touching;
    V3 normal;
    F overlap;
    V3 velocity;                     ///< v_i - v_j
    V3 surface;                      ///< (R_i - d/2) w_i + (R_j - d/2) w_j
    F root_radius;                   ///< sqrt(R*)
    F inverse_masses;                ///< 1/m_i + 1/m_j
    bool with_clumps;                ///< pair: masses differ, although radii may be equal
    F radius;                        ///< wall: R
    F closeness;                     ///< pair: (R_i + R_j)^2 - r^2
    F inverse_distance, difference;  ///< pair: 1/r, R_i - R_j
    V3 turning;                      ///< w_i - w_j; only with rolling resistance
    F rolling_inertia;               ///< 1/(sum of 1/(m R^2)); likewise
    F time_step;                     ///< 1: memories advance; 0: only forces are computed

    F effective_radius, normal_velocity, root, root_of_root;
    V3 slip;

    /// Computes the derived members.
    GRAINSWEEP_LANES void derive() {
        effective_radius = root_radius * root_radius;
        normal_velocity = dot(velocity, normal);
        const F squeezed = max(overlap, broadcast(1e-30f));
        if constexpr (!Kernel::reaches) overlap = squeezed;
        // sqrt(R* d) and its root: one uses the divider, the other multiplications, so that both units work in parallel
        root = root_radius * sqrt(squeezed);
        root_of_root = root * inverse_root(root);
        // A dashpot that is not limited would slow bodies down over the whole way of a bridge.
        if constexpr (Kernel::acts_apart) root_of_root = keep(broadcast(0.0f) < overlap, root_of_root);
        // tangential velocity at the contact: v - v_n n - surface x n
        if constexpr (Kernel::spin) slip = add_cross(fnma(normal_velocity, normal, velocity), normal, surface);
    }
    GRAINSWEEP_LANES void hold(M holds) { touching = touching & holds; }
    GRAINSWEEP_LANES void part(F) {}
    GRAINSWEEP_LANES void touch_over(F contact_radius) {
        root = contact_radius;
        root_of_root = root * inverse_root(root);
    }
    GRAINSWEEP_LANES F damped(const Arithmetic<F>::Damping& d) const { return root_of_root * damped_by_mass(d); }
    GRAINSWEEP_LANES F damped_by_mass(const Arithmetic<F>::Damping& d) const {
        if constexpr (partner == Partner::wall)
            return d.general * inverse_root(max(inverse_masses, broadcast(1e-12f)));
        else if constexpr (Kernel::unequal)
            return d.general * inverse_root(inverse_masses);
        else if constexpr (Kernel::holds)  // without clumps masses are 1, or one particle is frozen
            return with_clumps ? d.general * inverse_root(inverse_masses)
                               : select(broadcast(1.5f) < inverse_masses, d.of_pair, d.general);
        else
            return d.of_pair;
    }
    GRAINSWEEP_LANES F damped_beside(const Arithmetic<F>::Damping& d, F normal_damper) const {
        return normal_damper * d.over_normal;
    }
    template <bool lens>
    GRAINSWEEP_LANES F over_area(const Arithmetic<F>::AreaForce& f) const {
        if constexpr (partner == Partner::wall) return overlap * fma(f.wall_square, overlap, f.wall_linear * radius);
        F disc = closeness * f.disc;
        if constexpr (Kernel::unequal)
            disc = disc * fnma(difference * difference, inverse_distance * inverse_distance, broadcast(1.0f));
        if constexpr (lens) return disc;
        return fma(f.linear, effective_radius * overlap, fma(f.square, overlap * overlap, disc));
    }
    template <bool, class R>
    GRAINSWEEP_LANES static F limit(F l, F, const R&) {
        return l;
    }
    template <class X>
    GRAINSWEEP_LANES X kept(X x) const {
        if constexpr (Kernel::acts_apart) return keep(touching & (broadcast(0.0f) < overlap), x);
        return keep(touching, x);
    }
    GRAINSWEEP_LANES F lasting(F x) const { return keep(touching, x); }
};

template <class Kernel>
GRAINSWEEP_LANES void load_memory(float* const* column, std::int64_t at, F* memory) {
    for (int a = 0; a < Kernel::histories; ++a) memory[a] = load(column[a] + at);
}
template <class Kernel>
GRAINSWEEP_LANES void store_memory(float* const* column, std::int64_t at, const F* memory) {
    for (int a = 0; a < Kernel::histories; ++a) store(column[a] + at, memory[a]);
}

/// Writes the sum over both particles of n M n; `second` null: walls. A function of its own, so that the loops of
/// spheres keep their registers.
GRAINSWEEP_PHASE void write_inverse_masses(const Mobility* of, const Place* first, const Place* second,
                                           const float* normal, float* sum) {
    const auto at = [of](Place p) { return load8(of[p / places_per_index].of); };
    const V3 n{load(normal), load(normal + width), load(normal + 2 * width)};
    F m[8];
    if (second != nullptr)
        load_eights([&](int q) { return at(first[q]) + at(second[q]); }, m);
    else
        load_eights([&](int q) { return at(first[q]); }, m);
    const F x = fma(m[0], n.x, fma(m[1], n.y, m[2] * n.z)), y = fma(m[1], n.x, fma(m[3], n.y, m[4] * n.z)),
            z = fma(m[2], n.x, fma(m[4], n.y, m[5] * n.z));
    store(sum, dot({x, y, z}, n));
}
GRAINSWEEP_LANES F inverse_masses(const Mobility* of, const Place* first, const Place* second, V3 n) {
    float normal[3 * width], sum[width];
    store(normal, n.x), store(normal + width, n.y), store(normal + 2 * width, n.z);
    write_inverse_masses(of, first, second, normal, sum);
    return load(sum);
}

/// Result of the laws: force on i, direction of the torques n x (-F_t), minus the rolling moment on i; zero in lanes
/// without contact.
struct Outcome {
    V3 force, turn, rolling;
};

/// Applies the laws and updates the memory.
template <class Kernel, Partner partner>
GRAINSWEEP_LANES Outcome respond(const typename Kernel::Laws& laws, Meeting<Kernel, partner>& m, F* memory) {
    m.derive();
    if constexpr (Kernel::reaches) laws.begin(m, memory);
    const Response<F> r = laws.template respond<true>(m, memory);
    Outcome o{};
    if constexpr (Kernel::spin) {
        o.force = keep(m.touching, fms(m.normal, r.normal, r.resistance));
        o.turn = keep(m.touching, cross(m.normal, r.resistance));
    } else {
        o.force = keep(m.touching, m.normal * r.normal);
    }
    if constexpr (Kernel::rolls) o.rolling = keep(m.touching, r.rolling);
    return o;
}

}  // namespace
}  // namespace grainsweep::dem::fast
