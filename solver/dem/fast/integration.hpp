// Integration of particles whose forces are complete: leapfrog v(t+dt/2) = v(t-dt/2) + dt f/m, x(t+dt) = x(t) + dt
// v(t+dt/2), which is velocity Verlet with half-step velocities in the contact law. Rounding errors are carried to the
// next step: of position and velocity as in residual.hpp, of the spin in the sum of the torques. The files of the
// instruction paths include this file after their lanes; it has internal linkage on purpose.
#pragma once

#include "solver/dem/fast/contact.hpp"

namespace grainsweep::dem::fast {
namespace {

/// Constants and extremes of the integration.
struct Stepper {
    F8 turning;  ///< factor of force and torque in addition to 1/m
    F8 gravity;
    F8 high, low;  ///< extremes of velocity and spin
    F4 inverse_unit;
};

GRAINSWEEP_LANES Stepper stepper(const Constants& c, const Tally& t) {
    const float r = c.rotation;
    alignas(32) const float turning[8] = {1, 1, 1, 0, r, r, r, 0};
    return {load8(turning), load8(c.gravity), load8(t.velocity_high), load8(t.velocity_low), load4(c.inverse_unit)};
}

/// Advances one particle. `may_be_held`: particles with inverse mass 0 get no gravity.
template <class Kernel, bool may_be_held>
GRAINSWEEP_LANES void advance_one(Record& r, Force& force, Residual* residual, Stepper& s) {
    const F8 inverse_mass = broadcast8(r.inverse_mass);
    const F8 sum = load8(force.force);
    F8 change = sum * s.turning;
    if constexpr (Kernel::unequal) {
        const F4 inverse_radius = broadcast4(r.inverse_radius);
        change = change * join(broadcast4(1.0f), inverse_radius * inverse_radius);
    }
    F8 gravity = s.gravity;
    if constexpr (may_be_held) gravity = where_positive(inverse_mass, gravity);
    F4 of_position;
    F8 of_velocity;
    if constexpr (Kernel::unequal) {
        const F8 residue = load8(residual->position);
        of_position = low(residue);
        of_velocity = join(high(residue), broadcast4(0.0f));
    } else {
        of_position = load4(r.rest);  // the fourth lane is far below a unit and has no effect
        of_velocity = fourths(of_position, sum);
    }
    change = fma(change, inverse_mass, gravity) + of_velocity;
    const F8 old = load8(r.velocity);
    const F8 now = old + change;
    const F8 lost = change - (now - old);
    // The rounding error of the spin is stored as a torque for the next step; a rebuild removes it.
    F4 waiting = broadcast4(0.0f);
    if constexpr (Kernel::spin) {
        float inertia = 0.1f;  // 0.4 m R^2, diameter and mass 1
        if constexpr (Kernel::unequal) {
            const float square = r.rest[3] * r.rest[3];
            inertia = 3.2f * square * square * r.rest[3];
        }
        waiting = high(lost) * broadcast4(inertia);
    }
    if constexpr (Kernel::unequal)
        store8(force.force, join(broadcast4(0.0f), waiting));
    else
        store8(force.force, with_fourths(broadcast4(0.0f), waiting, low(lost)));
    s.high = max(now, s.high);
    s.low = min(now, s.low);
    const F4 travel = fma(low(now), s.inverse_unit, of_position);
    const I4 units = rounded(travel);
    const I4 position = load4(r.position) + units;
    const F4 left = travel - single(units);
    store4(r.position, position);
    store8(r.velocity, now);
    if constexpr (Kernel::unequal) {
        store8(residual->position, join(left, low(lost)));
        const float radius = r.rest[3];
        store4(r.rest, high(now) * broadcast4(radius));
        r.rest[3] = radius;
    } else {
        store4(r.rest, with_fourth<0>(left, low(lost)));
    }
}

/// Integrates the particles [from, to).
template <class Kernel>
GRAINSWEEP_PHASE void advance_range(const Field& f, std::int32_t from, std::int32_t to, Tally& t) {
    Stepper s = stepper(f.constants, t);
    // local copies: after a store of lanes the compiler would read them from the field again
    Record* const records = f.records;
    Force* const forces = f.forces;
    const auto residual_of = [residuals = f.residuals, ahead = f.read_ahead != 0](std::int32_t i) {
        if constexpr (Kernel::unequal) {
            if (ahead) prefetch(residuals + i + 64);
            return residuals + i;
        } else {
            return nullptr;
        }
    };
    // Prefetches the partners of later pairs once per particle. Once per pair, as sift() does for many particles, is
    // slower for few particles (docs/tried_and_dropped.md).
    const auto fetch = [records, forces, ahead = f.fetch_ahead, last = f.end - 1](std::int32_t i) {
        if (ahead == 0) return;
        const std::int32_t k = i + ahead < last ? i + ahead : last;
        prefetch(records + k);
        prefetch(forces + k);
    };
    if (Kernel::holds && f.skips != 0) {
        const std::int32_t* const advanced = f.advanced;
        const std::int32_t end = f.advanced_before[to];
        for (std::int32_t k = f.advanced_before[from]; k < end; ++k) {
            const std::int32_t i = advanced[k];
            fetch(i);
            advance_one<Kernel, false>(records[i], forces[i], residual_of(i), s);
        }
    } else {
        for (std::int32_t i = from; i < to; ++i) {
            fetch(i);
            advance_one<Kernel, Kernel::holds>(records[i], forces[i], residual_of(i), s);
        }
    }
    store8(t.velocity_high, s.high);
    store8(t.velocity_low, s.low);
}

template <class Kernel>
void advance(const Field& f, Tally& t) {
    const auto denormals = flush_denormals();
    advance_range<Kernel>(f, f.begin, f.end, t);
    restore_denormals(denormals);
}

}  // namespace
}  // namespace grainsweep::dem::fast
