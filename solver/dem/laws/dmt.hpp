// Adhesion of stiff, weakly attracting spheres: a constant attraction while they touch.
//
//     F_n = (4/3) E* sqrt(R* d) d - 2 pi w R*,  d > 0          w: work of adhesion, J/m2
//
// Derjaguin, Muller & Toporov (1975), J. Colloid Interface Sci. 53, 314, in the form of Maugis (2000), Contact,
// Adhesion and Rupture of Elastic Solids, sect. 4.2.5. Pull-off is at d = 0 with the force 2 pi w R*. Coulomb's limit
// uses the contact force without the attraction, or the net force where it repels (Material::friction_limit).
#pragma once

#include "solver/dem/laws/jkr.hpp"

namespace grainsweep::dem {

template <class Real>
struct Dmt : LawTraits {
    using A = Arithmetic<Real>;
    static constexpr Aspect aspect = Aspect::cohesion;
    static constexpr int constants = 2;

    static bool wanted(const Material& m) { return m.surface_energy > 0 && m.cohesion_law == CohesionLaw::dmt; }
    /// Also suits materials without adhesion, beside others with adhesion.
    static bool suits(const Material& m) { return m.cohesion_law == CohesionLaw::dmt; }
    static std::array<Quantity, constants> constants_of(const Material& m) {
        return {{{2 * std::numbers::pi * m.surface_energy, energy_per_area},
                 {m.friction_limit == FrictionLimit::net ? 1.0 : 0.0, number}}};
    }
    explicit Dmt(const double* c) : adhesion(A::number(c[0])), seen(A::number(c[1])) {}

    Real adhesion;  ///< 2 pi w, N/m
    Real seen;      ///< 1: Coulomb's limit includes the attraction, 0: it does not

    template <bool advance, class T>
    [[gnu::always_inline]] void add(const T& t, Response<Real>& r, Real*) const {
        const Real attraction = adhesion * t.effective_radius;
        r.normal = r.normal - attraction;
        r.seen = A::fnma(seen, attraction, r.seen);
    }

    /// Returns minus the work of the attraction since first touch, J.
    template <class T>
    [[nodiscard]] Real energy(const T& t, const Real*) const {
        return -adhesion * t.effective_radius * t.overlap;
    }
};

inline constexpr Attraction dmt_row{
    "dmt", "by surface_energy, Derjaguin, Muller & Toporov", surface_energy, true,
    [](const Material& m, double radius) { return 2 * std::numbers::pi * m.surface_energy * (radius / 2); }};

}  // namespace grainsweep::dem
