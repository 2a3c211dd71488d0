// Liquid bridges: they form at touch, attract the bodies, and break at a critical gap.
//
//     F = 2 pi R_D g cos(theta)/(1 + 1.05 x + 2.5 x^2),   x = s sqrt(R_D/V),   s the gap; 0 while the bodies touch
//     rupture at s_c = (1 + theta/2) V^(1/3)
//     R_D = 2 R_i R_j/(R_i + R_j) = 2 R*, a wall 2 R;   V = c 4/3 pi R_V^3, R_V = R_D of a pair, R at a wall
//
// g: surface tension, N/m; theta: contact angle, rad; c: bridge volume as a share of a sphere's. Willett, Adams,
// Johnson & Seville (2000), Langmuir 16, 9396, their closed form for small bridges in Derjaguin's approximation, least
// accurate near touch and near rupture; Lian, Thornton & Adams (1993), J. Colloid Interface Sci. 161, 138.
// The volume of a bridge is constant: liquid neither moves nor is used up, and bridges of one particle do not merge.
// Viscous force and weight of the liquid are neglected.
//
// Forming and breaking a bridge dissipates the work of separation,
//     W = 2 pi g cos(theta) sqrt(R_D V) (2/q) (atan((5 x_c + 1.05)/q) - atan(1.05/q)),  q = sqrt(10 - 1.05^2),
// so that slower impacts stick. Coulomb's limit uses the contact force without the attraction, or, while bodies touch,
// the net force where it repels (Material::friction_limit).
#pragma once

#include "solver/dem/laws/touch.hpp"
#include "solver/dem/material.hpp"

#include <algorithm>
#include <cmath>

namespace grainsweep::dem {

template <class Real>
struct Capillary : LawTraits {
    using A = Arithmetic<Real>;
    static constexpr Aspect aspect = Aspect::cohesion;
    static constexpr bool reaches = true, acts_apart = true;
    static constexpr MemoryKind memory_kind{1, 1, number};  ///< 1 while there is a bridge
    static constexpr int constants = 4;

    static bool wanted(const Material& m) { return m.surface_tension > 0 && m.cohesion_law == CohesionLaw::capillary; }
    /// Also suits materials without liquid, beside others with liquid.
    static bool suits(const Material& m) { return m.cohesion_law == CohesionLaw::capillary; }
    static std::array<Quantity, constants> constants_of(const Material& m) {
        return {{{4 * std::numbers::pi * m.surface_tension * std::cos(m.contact_angle), energy_per_area},
                 {wanted(m) ? rupture(m) : 0.0, number},
                 {1 / std::sqrt(sphere_share(m)), number},
                 {m.friction_limit == FrictionLimit::net ? 1.0 : 0.0, number}}};
    }
    explicit Capillary(const double* c)
        : strength(A::number(c[0])), reach(A::number(c[1])), steepness(A::number(c[2])), seen(A::number(c[3])) {}

    Real strength;   ///< 4 pi g cos(theta): the force at touch divided by R*, N/m
    Real reach;      ///< s_c/R_V
    Real steepness;  ///< sqrt(R_V^3/V)
    Real seen;       ///< 1: Coulomb's limit includes the attraction, 0: it does not

    /// Returns the largest gap, m; at a wall it is half of this.
    static double beyond(const Material& m, double effective_radius) {
        return wanted(m) ? 2 * rupture(m) * effective_radius : 0;
    }

    /// Decides whether there is a bridge, or a contact that will form one.
    template <class T>
    [[gnu::always_inline]] void begin(T& t, const Real* bridge) const {
        t.hold(A::fnma(reach * volume_radius(t), bridge[0], A::number(0)) < t.overlap);
        t.part(A::number(0) - t.overlap);
    }

    template <bool advance, class T>
    [[gnu::always_inline]] void add(const T& t, Response<Real>& r, Real* bridge) const {
        const Real x = relative_gap(t, A::larger(A::number(0) - t.overlap, A::number(0)));
        const Real attraction =
            A::divided(strength * t.effective_radius, A::number(1) + x * (A::number(linear) + A::number(square) * x));
        r.normal = r.normal - attraction;
        r.seen = A::fnma(seen, t.kept(attraction), r.seen);
        if constexpr (advance) bridge[0] = t.lasting(A::number(1));
    }

    /// Returns minus the work that is left until the bridge breaks, J.
    template <class T>
    [[nodiscard]] Real energy(const T& t, const Real*) const {
        const double gap = std::max(-t.overlap, 0.0), force = strength * t.effective_radius;
        const double whole = reach * volume_radius(t), per_gap = relative_gap(t, 1.0);
        const double work = per_gap > 0 ? force / per_gap * (integral(per_gap * whole) - integral(per_gap * gap)) : 0;
        return -work - force * std::max(t.overlap, 0.0);
    }

private:
    static constexpr double linear = 1.05, square = 2.5;

    /// Returns V/R_V^3.
    static double sphere_share(const Material& m) { return 4.0 / 3 * std::numbers::pi * m.bridge_volume; }
    static double rupture(const Material& m) { return (1 + m.contact_angle / 2) * std::cbrt(sphere_share(m)); }
    /// Returns R_V, m.
    template <class T>
    [[gnu::always_inline]] static Real volume_radius(const T& t) {
        if constexpr (T::partner == Partner::wall) return t.effective_radius;
        return t.effective_radius + t.effective_radius;
    }
    /// Returns x of a gap: sqrt(R_D/V) is sqrt(R_V^3/V)/R_V, at a wall sqrt(2) times as much.
    template <class T>
    [[nodiscard, gnu::always_inline]] Real relative_gap(const T& t, Real gap) const {
        const Real x = A::divided(gap * steepness, volume_radius(t));
        if constexpr (T::partner == Partner::wall) return A::number(std::numbers::sqrt2) * x;
        return x;
    }
    /// Returns the integral of 1/(1 + 1.05 x + 2.5 x^2) from 0.
    static double integral(double x) {
        const double q = std::sqrt(4 * square - linear * linear);
        return 2 / q * (std::atan((2 * square * x + linear) / q) - std::atan(linear / q));
    }
};

inline constexpr std::array liquid = {
    fields::quantity<&Material::surface_tension>("surface_tension", "N/m", "of the liquid of capillary", {0, 10}),
    fields::quantity<&Material::contact_angle>("contact_angle", "rad", "of the liquid of capillary",
                                               {0, std::numbers::pi / 2, false, true}),
    fields::quantity<&Material::bridge_volume>("bridge_volume", "1",
                                               "of capillary: volume of a liquid bridge divided by that of a sphere of "
                                               "the mean radius 2 R1 R2/(R1 + R2), at a wall of the sphere",
                                               {0, 0.03, true, false})};  // larger ones would merge
inline constexpr Attraction capillary_row{
    "capillary",
    "by liquid bridges",
    liquid,
    true,
    nullptr,
    [](const Material& m, const Material& other) {
        return (m.cohesion_law == CohesionLaw::capillary) == (other.cohesion_law == CohesionLaw::capillary)
                   ? nullptr
                   : "all contacts of a case have the law capillary or none: without surface tension where no bridges "
                     "are";
    },
    Capillary<double>::beyond};

}  // namespace grainsweep::dem
