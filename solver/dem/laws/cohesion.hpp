// Cohesion proportional to a contact area (Johnson, Kendall & Roberts, simplified):  F = -k A n.
//
// k is the cohesion energy density (J/m3 = Pa). Three areas are available; r is the distance of the centres:
//     sjkr    pair  A = -pi/4 (r-Ri-Rj)(r+Ri-Rj)(r-Ri+Rj)(r+Ri+Rj)/r^2, the disc in which the spheres intersect
//             wall  A = pi (2 R d - d^2)                                       (LIGGGHTS 3.8 `sjkr`)
//     sjkr2   pair  A = 4 pi R* d            wall  A = 2 pi R d                (LIGGGHTS 3.8 `sjkr2`)
//     paper   A = pi (2 R* d - d^2)/4, pair and wall alike (Gupta, eq. 15 read literally)
// Coulomb's limit uses the contact force without F, or the net force where it repels (Material::friction_limit).
// The stored energy is minus k times the integral of A over the overlap.
#pragma once

#include "solver/dem/laws/touch.hpp"
#include "solver/dem/material.hpp"

namespace grainsweep::dem {

[[nodiscard]] inline AreaForm area_of(CohesionLaw law) {
    using std::numbers::pi;
    switch (law) {
        case CohesionLaw::sjkr:
            return {.disc = pi / 4, .wall_cap = pi};
        case CohesionLaw::sjkr2:
            return {.band = 4 * pi, .wall_band = 2 * pi};
        case CohesionLaw::paper:
            return {.cap = pi / 4, .wall_cap = pi / 4};
        default:
            return {};  // not by area
    }
}

/// Returns the largest value of a d - b d^(3/2), b = 4/3 E* sqrt(R*): 4 a^3/(27 b^2), R* = R/2. To first order in the
/// overlap d, a = k A/d of equal spheres.
inline double pull_off_over_area(const Material& m, double radius) {
    const AreaForm area = area_of(m.cohesion_law);
    const double a = m.cohesion * (4 * area.disc + area.band / 2 + area.cap) * radius;
    const double modulus = effective_modulus(m);
    return a * a * a / (6 * modulus * modulus * radius);
}

inline constexpr std::array cohesion = {fields::quantity<&Material::cohesion>(
    "cohesion", "J/m3", "cohesion energy density of sjkr, sjkr2, paper", {0, 1e9})};
inline constexpr Attraction sjkr_row{"sjkr", "cohesion times the cut of the spheres", cohesion, false,
                                     pull_off_over_area};
inline constexpr Attraction sjkr2_row{"sjkr2", "cohesion times 4 pi R* d", cohesion, false, pull_off_over_area};
inline constexpr Attraction paper_row{"paper", "cohesion times pi (2 R* d - d^2)/4", cohesion, false,
                                      pull_off_over_area};

/// Cohesion by area. `lens`: sjkr without effect on friction, which is compiled as a separate law.
template <class Real, bool lens>
struct CohesionOver : LawTraits {
    using A = Arithmetic<Real>;
    static constexpr Aspect aspect = Aspect::cohesion;
    static constexpr int constants = 7;

    static bool acts_over_area(const Material& m) { return attraction_of(m).key() == "cohesion"; }
    static bool wanted(const Material& m) { return m.cohesion > 0 && acts_over_area(m); }
    static bool suits(const Material& m) {
        if (!acts_over_area(m)) return !(attraction_of(m).amount(m) > 0);
        return !lens || (m.cohesion_law == CohesionLaw::sjkr && m.friction_limit == FrictionLimit::contact);
    }
    static std::array<Quantity, constants> constants_of(const Material& m) {
        const AreaForm a = area_of(m.cohesion_law);
        return {{{m.cohesion, pressure},
                 {a.disc, number},
                 {a.band, number},
                 {a.cap, number},
                 {a.wall_band, number},
                 {a.wall_cap, number},
                 {m.friction_limit == FrictionLimit::net ? 1.0 : 0.0, number}}};
    }
    explicit CohesionOver(const double* c)
        : force(A::area_force(c[0], {c[1], c[2], c[3], c[4], c[5]})), seen(A::number(c[6])) {}

    typename A::AreaForce force;
    Real seen;  ///< 1: Coulomb's limit includes the cohesive force, 0: it does not

    template <bool advance, class T>
    [[gnu::always_inline]] void add(const T& t, Response<Real>& r, Real*) const {
        const Real attraction = t.template over_area<lens>(force);
        r.normal = r.normal - attraction;
        if constexpr (!lens) r.seen = A::fnma(seen, attraction, r.seen);
    }

    /// Returns minus the work of the attraction since first touch, J: every area is proportional to d to first order.
    template <class T>
    [[nodiscard]] Real energy(const T& t, const Real*) const {
        return -0.5 * t.template over_area<lens>(force) * t.overlap;
    }
};

template <class Real>
using Cohesion = CohesionOver<Real, false>;
template <class Real>
using LensCohesion = CohesionOver<Real, true>;

}  // namespace grainsweep::dem
