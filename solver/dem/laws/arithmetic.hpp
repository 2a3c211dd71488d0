// Arithmetic of the laws: numbers are doubles (here), or vectors of floats with one contact per lane
// (fast/lane_arithmetic.hpp). A law is one template for both: `template <class Real> struct NAME`.
//
// Sums and products of three numbers are evaluated from the left here, and from the right and fused in lanes; `spring`
// and `product` keep this order. A limit is tested by comparing sizes here, by an inverse root in lanes.
#pragma once

#include "solver/geometry/vector.hpp"

#include <cmath>
#include <limits>

namespace grainsweep::dem {

/// Contact area A = disc x (the disc in which two spheres intersect) + band R* d + cap (2 R* - d) d, m2.
struct AreaForm {
    double disc = 0, band = 0, cap = 0;  ///< at a pair
    double wall_band = 0, wall_cap = 0;  ///< at a wall
};

/// Test whether a tangential or rolling spring exceeds its limit, the factor that reduces it to the limit, and what it
/// leaves of the limit, at least a given number.
template <class Real, class Mask>
struct Cut {
    Mask exceeds;
    Real scale, left;
};

template <class Real>
struct Arithmetic;

template <>
struct Arithmetic<double> {
    using Vector = geometry::Vec3;
    using Mask = bool;
    /// Coefficient c of a damper c sqrt(m* a), a the radius of the contact, and c divided by that of the normal damper.
    struct Damping {
        double coefficient, over_normal;
    };
    /// Force per area times a contact area.
    struct AreaForce {
        double strength;
        AreaForm form;
    };

    static double number(double x) { return x; }
    static Damping damping(double coefficient, double over_normal = 1) { return {coefficient, over_normal}; }
    static AreaForce area_force(double strength, const AreaForm& form) { return {strength, form}; }
    static Vector vector(const double* memory) { return {memory[0], memory[1], memory[2]}; }
    static void remember(double* memory, const Vector& v) {
        for (std::size_t k = 0; k < 3; ++k) memory[k] = v[k];
    }
    static constexpr int iterations = 4;  ///< of Halley's method from a start within 30 %
    static double divided(double a, double b) { return a / b; }
    static double larger(double a, double b) { return a < b ? b : a; }
    static double smaller(double a, double b) { return b < a ? b : a; }
    static double inverse_cbrt(double a) { return 1 / std::cbrt(a); }  ///< a > 0
    static double product(double a, double b, double c) { return a * b * c; }
    static double fnma(double a, double b, double c) { return c - a * b; }  ///< c - a b
    static double abs(double a) { return std::abs(a); }
    static double sqrt(double a) { return std::sqrt(a); }
    static double drop(bool m, double a) { return m ? 0.0 : a; }  ///< a, or 0 if m is true
    static bool either(bool m, bool n) { return m || n; }
    /// v + factor w
    static Vector add(const Vector& v, double factor, const Vector& w) {
        using namespace geometry;
        return v + factor * w;
    }
    /// Returns v without its component along n.
    static Vector across(const Vector& v, const Vector& n) { return add(v, -geometry::dot(v, n), n); }
    static Vector scaled(const Vector& v, double factor) { return geometry::operator*(factor, v); }
    /// Returns a vector of this size in the direction of v; 0 if v is 0.
    static Vector directed(double size, const Vector& v) {
        const double length = geometry::norm(v);
        return scaled(v, length > 0 ? size / length : 0.0);
    }
    /// Returns a/|v|; beyond any number if v is 0.
    static double over_length(double a, const Vector& v) {
        const double length = geometry::norm(v);
        return length > 0 ? a / length : std::numeric_limits<double>::infinity();
    }
    /// Compares k |s| with a limit.
    [[gnu::always_inline]] static Cut<double, bool> cut(double k, const Vector& s, double limit, double least) {
        return cut_to(k * std::sqrt(geometry::dot(s, s)), limit, least);
    }
    [[gnu::always_inline]] static Cut<double, bool> cut(const Vector& s, double limit, double least) {
        return cut_to(geometry::norm(s), limit, least);
    }
    /// k scale s + viscosity v
    static Vector spring(double k, double scale, const Vector& s, double viscosity, const Vector& v) {
        using namespace geometry;
        return (k * scale) * s + viscosity * v;
    }

private:
    // Both results are computed and one is selected, because a branch would be hard to predict.
    [[gnu::always_inline]] static Cut<double, bool> cut_to(double size, double limit, double least) {
        const bool exceeds = size > limit;
        return {exceeds, exceeds ? limit / size : 1.0, exceeds ? least : larger(limit - size, least)};
    }
};

}  // namespace grainsweep::dem
