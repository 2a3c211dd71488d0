// Arithmetic of the laws (laws/arithmetic.hpp) for the lanes of a vector, one contact each, in the engine's units. The
// files of the instruction paths include this file after their lanes; it has internal linkage on purpose.
#pragma once

#include "solver/dem/fast/layout.hpp"

namespace grainsweep::dem::fast {
namespace {

// One Newton step gives the processor's estimate full single precision.
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
/// |a|^2 + floor
GRAINSWEEP_LANES F square(V3 a, float floor) {
    return fma(a.x, a.x, fma(a.y, a.y, fma(a.z, a.z, broadcast(floor))));
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
GRAINSWEEP_LANES V3 zero_vector() {
    return {broadcast(0.0f), broadcast(0.0f), broadcast(0.0f)};
}
GRAINSWEEP_LANES V3 operator+(V3 a, V3 b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
GRAINSWEEP_LANES V3 operator-(V3 a, V3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
GRAINSWEEP_LANES V3 operator*(V3 a, F b) {
    return {a.x * b, a.y * b, a.z * b};
}
/// b - f a
GRAINSWEEP_LANES V3 fnma(F f, V3 a, V3 b) {
    return {fnma(f, a.x, b.x), fnma(f, a.y, b.y), fnma(f, a.z, b.z)};
}
/// b + a f
GRAINSWEEP_LANES V3 fma(V3 a, F f, V3 b) {
    return {fma(a.x, f, b.x), fma(a.y, f, b.y), fma(a.z, f, b.z)};
}
/// a f - b
GRAINSWEEP_LANES V3 fms(V3 a, F f, V3 b) {
    return {fms(a.x, f, b.x), fms(a.y, f, b.y), fms(a.z, f, b.z)};
}

struct D3 {
    D x, y, z;
};
GRAINSWEEP_LANES D3 broadcast(const double* v) {
    return {broadcast(v[0]), broadcast(v[1]), broadcast(v[2])};
}
GRAINSWEEP_LANES D3 operator-(D3 a, D3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
GRAINSWEEP_LANES V3 single(D3 a) {
    return {single(a.x), single(a.y), single(a.z)};
}
GRAINSWEEP_LANES D3 exact(V3 a) {
    return {exact(a.x), exact(a.y), exact(a.z)};
}
/// b - f a
GRAINSWEEP_LANES D3 fnma(D f, D3 a, D3 b) {
    return {fnma(f, a.x, b.x), fnma(f, a.y, b.y), fnma(f, a.z, b.z)};
}
/// c + a x b
GRAINSWEEP_LANES D3 add_cross(D3 c, D3 a, D3 b) {
    return {fnma(a.z, b.y, fma(a.y, b.z, c.x)), fnma(a.x, b.z, fma(a.z, b.x, c.y)), fnma(a.y, b.x, fma(a.x, b.y, c.z))};
}
GRAINSWEEP_LANES D3 operator+(D3 a, D3 b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
GRAINSWEEP_LANES D3 operator*(D3 a, D b) {
    return {a.x * b, a.y * b, a.z * b};
}
GRAINSWEEP_LANES D dot(D3 a, D3 b) {
    return fma(a.x, b.x, fma(a.y, b.y, a.z * b.z));
}
/// b + a f
GRAINSWEEP_LANES D3 fma(D3 a, D f, D3 b) {
    return {fma(a.x, f, b.x), fma(a.y, f, b.y), fma(a.z, f, b.z)};
}

}  // namespace
}  // namespace grainsweep::dem::fast

namespace grainsweep::dem {

template <>
struct Arithmetic<fast::F> {
    using F = fast::F;
    using V3 = fast::V3;
    using Vector = V3;
    using Mask = fast::M;
    /// Coefficient, and its product with sqrt(m*) of two mobile particles of mass 1.
    struct Damping {
        F general, of_pair, over_normal;
    };
    /// Strength times contact area as a polynomial of the overlap.
    struct AreaForce {
        F disc;                      ///< per disc divided by pi/4
        F linear, square;            ///< per R* d, d^2
        F wall_linear, wall_square;  ///< per R d, d^2
    };

    GRAINSWEEP_LANES static F number(double x) { return fast::broadcast(static_cast<float>(x)); }
    GRAINSWEEP_LANES static Damping damping(double coefficient, double over_normal = 1) {
        constexpr double root_of_half = 0.70710678118654752440;
        return {number(coefficient), number(coefficient * root_of_half), number(over_normal)};
    }
    GRAINSWEEP_LANES static AreaForce area_force(double strength, const AreaForm& a) {
        return {number(strength * a.disc), number(strength * (a.band + 2 * a.cap)), number(-strength * a.cap),
                number(strength * (a.wall_band + 2 * a.wall_cap)), number(-strength * a.wall_cap)};
    }
    GRAINSWEEP_LANES static V3 vector(const F* memory) { return {memory[0], memory[1], memory[2]}; }
    GRAINSWEEP_LANES static void remember(F* memory, V3 v) { memory[0] = v.x, memory[1] = v.y, memory[2] = v.z; }
    static constexpr int iterations = 2;
    GRAINSWEEP_LANES static F divided(F a, F b) { return a * fast::inverse(b); }
    GRAINSWEEP_LANES static F larger(F a, F b) { return fast::max(a, b); }
    GRAINSWEEP_LANES static F smaller(F a, F b) { return fast::min(a, b); }
    /// Returns a^(-1/3) for a > 0 by an iteration of third order without divisions; the start is within 4 %.
    GRAINSWEEP_LANES static F inverse_cbrt(F a) {
        F y = fast::start_of_inverse_cbrt(a);
        for (int k = 0; k < 2; ++k) {
            const F h = number(1) - a * y * y * y;
            y = y + y * h * (number(1.0 / 3) + number(2.0 / 9) * h);
        }
        return y;
    }
    GRAINSWEEP_LANES static F product(F a, F b, F c) { return a * (b * c); }
    GRAINSWEEP_LANES static F fnma(F a, F b, F c) { return fast::fnma(a, b, c); }
    GRAINSWEEP_LANES static F abs(F a) { return fast::abs(a); }
    GRAINSWEEP_LANES static F sqrt(F a) { return fast::sqrt(a); }
    GRAINSWEEP_LANES static F drop(Mask m, F a) { return fast::drop(m, a); }
    GRAINSWEEP_LANES static Mask either(Mask m, Mask n) { return m | n; }
    GRAINSWEEP_LANES static V3 add(V3 v, F factor, V3 w) { return fast::fma(w, factor, v); }
    GRAINSWEEP_LANES static V3 across(V3 v, V3 n) { return fast::fnma(dot(v, n), n, v); }
    GRAINSWEEP_LANES static V3 scaled(V3 v, F factor) { return v * factor; }
    GRAINSWEEP_LANES static V3 directed(F size, V3 v) { return v * (size * fast::inverse_root(square(v, 1e-37f))); }
    /// The divider is idle here, unlike multiplication.
    GRAINSWEEP_LANES static F over_length(F a, V3 v) { return a / fast::sqrt(square(v, 1e-37f)); }
    GRAINSWEEP_LANES static Cut<F, Mask> cut(F k, V3 s, F limit, F least) {
        return cut_to(fast::fma(k * k, dot(s, s), number(1e-37)), limit, least);
    }
    GRAINSWEEP_LANES static Cut<F, Mask> cut(V3 s, F limit, F least) { return cut_to(square(s, 1e-37f), limit, least); }
    GRAINSWEEP_LANES static V3 spring(F k, F scale, V3 s, F viscosity, V3 v) {
        const V3 damped = v * viscosity;
        s = s * scale;
        return {fast::fma(k, s.x, damped.x), fast::fma(k, s.y, damped.y), fast::fma(k, s.z, damped.z)};
    }

private:
    GRAINSWEEP_LANES static Cut<F, Mask> cut_to(F size_squared, F limit, F least) {
        const F inverse = fast::inverse_root(size_squared), ratio = limit * inverse;
        return {ratio < fast::broadcast(1.0f), fast::min(ratio, fast::broadcast(1.0f)),
                fast::max(fast::fnma(size_squared, inverse, limit), least)};
    }
};

}  // namespace grainsweep::dem
