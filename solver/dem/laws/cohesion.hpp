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

/// Cohesion by area. `lens`: sjkr without effect on friction, which is compiled as a separate law.
template <class Real, bool lens>
struct CohesionOver : LawTraits {
    using A = Arithmetic<Real>;
    static constexpr Aspect aspect = Aspect::cohesion;
    static constexpr int constants = 7;

    static bool wanted(const Material& m) { return m.cohesion > 0 && acts_over_area(m.cohesion_law); }
    static bool suits(const Material& m) {
        if (acts_by_surface_energy(m.cohesion_law)) return !(m.surface_energy > 0);
        if (m.cohesion_law == CohesionLaw::capillary) return !(m.surface_tension > 0);
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
