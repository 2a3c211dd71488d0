// Adhesion of soft spheres: a contact that begins at touch and lasts beyond it.
//
//     a^4 - 2 R* d a^2 - (2 pi w R*^2/E*) a + R*^2 d^2 = 0,  a the largest root        w: work of adhesion, J/m2
//     F_n = 4 E* a^3/(3 R*) - sqrt(8 pi w E* a^3) = 4/3 E* a d - 2/3 sqrt(2 pi w E* a^3)
//     the contact begins at d = 0 and ends at d_c = -3/4 (pi^2 w^2 R*/E*^2)^(1/3); pull-off force F_po = 3/2 pi w R*
//
// Johnson, Kendall & Roberts (1971), Proc. R. Soc. Lond. A 324, 301. Hertz's law then uses the radius a instead of
// sqrt(R* d), and this law adds the other terms. Damping, tangential and rolling stiffness use a as well (as 2 E* a, 8
// G* a). With a_0^3 = 9 pi w R*^2/(2 E*) and y = sqrt(a/a_0) the quartic is
//     y^4 - (2/3) y = s,  s = d R*/a_0^2 > -6^(-1/3)/2
// and, after Ferrari, y = (k + sqrt(4/(3 k) - k^2))/2 with k^2 = m, m^3 + 4 s m = 4/9. This root is simple and well
// conditioned for every s: Halley's iteration from a start within 28 % triples its digits in each step
// (3.8e-3, 1.8e-8). (The closed form of Parteli et al. (2014), Sci. Rep. 4, 6227, is the same root; it loses digits
// where |d| is small.)
//
// Coulomb's limit: F_n + 2 F_po (Thornton & Yin (1991), Powder Technol. 65, 153), or the net force where it repels
// (Material::friction_limit). Rolling by constant torque uses 4/3 E* a d minus the attraction plus 2 F_po instead of
// k_n d. The energy is 0 at the end of the contact. First touch releases 7.09 (w^5 R*^4/E*^2)^(1/3) (Thornton & Ning
// (1998), Powder Technol. 99, 154), which is dissipated, so slower impacts stick.
#pragma once

#include "solver/dem/laws/touch.hpp"
#include "solver/dem/material.hpp"

namespace grainsweep::dem {

template <class Real>
struct Jkr : LawTraits {
    using A = Arithmetic<Real>;
    static constexpr Aspect aspect = Aspect::cohesion;
    static constexpr bool reaches = true;
    static constexpr MemoryKind memory_kind{1, 1, number};  ///< 1 while the contact lasts
    static constexpr int constants = 5;

    static bool wanted(const Material& m) { return m.surface_energy > 0 && m.cohesion_law == CohesionLaw::jkr; }
    static bool suits(const Material& m) { return wanted(m); }
    static std::array<Quantity, constants> constants_of(const Material& m) {
        using std::numbers::pi;
        const double w = m.surface_energy, modulus = effective_modulus(m);
        const double size = std::cbrt(4.5 * pi * w / modulus);
        return {{{size, {.length = 1.0 / 3}},
                 {1 / (size * size), {.length = -2.0 / 3}},
                 {2.0 / 3 * std::sqrt(2 * pi * w * modulus), {.length = -0.5, .mass = 1, .time = -2}},
                 {3 * pi * w, energy_per_area},
                 {m.friction_limit == FrictionLimit::net ? 0.0 : 1.0, number}}};
    }
    explicit Jkr(const double* c)
        : size(A::number(c[0])),
          inverse_size_squared(A::number(c[1])),
          strength(A::number(c[2])),
          pull(A::number(c[3])),
          limit(A::number(c[4])) {}

    Real size;                  ///< a_0/R*^(2/3)
    Real inverse_size_squared;  ///< 1/size^2
    Real strength;              ///< 2/3 sqrt(2 pi w E*)
    Real pull;                  ///< 2 F_po/R*
    Real limit;                 ///< 1: Coulomb's limit includes 2 F_po, 0: it uses the net force

    /// Returns |d_c|, m.
    static double beyond(const Material& m, double effective_radius) {
        if (!wanted(m)) return 0;
        const double ratio = std::numbers::pi * m.surface_energy / effective_modulus(m);
        return 0.75 * std::cbrt(ratio * ratio * effective_radius);
    }

    /// Decides whether there is a contact, and computes its radius.
    template <class T>
    [[gnu::always_inline]] void begin(T& t, const Real* lasting) const {
        const Real inverse_root = A::inverse_cbrt(t.effective_radius);  // R*^(-1/3)
        const Real s = t.overlap * inverse_size_squared * inverse_root;
        t.hold(A::number(least) * lasting[0] < s);
        const Real y = shape(A::larger(s, A::number(least)));
        t.touch_over(size * (t.effective_radius * inverse_root) * y * y);
    }

    template <bool advance, class T>
    [[gnu::always_inline]] void add(const T& t, Response<Real>& r, Real* lasting) const {
        const Real attraction = strength * t.root * A::sqrt(t.root);
        const Real twice_pull_off = pull * t.effective_radius;
        r.normal = r.normal - attraction;
        r.seen = r.seen - attraction + limit * twice_pull_off;
        r.elastic = r.elastic - attraction + twice_pull_off;
        if constexpr (advance) lasting[0] = t.kept(A::number(1));
    }

    /// Returns the energy of the contact in addition to Hertz's part 8/15 E* a d^2, J.
    template <class T>
    [[nodiscard]] Real energy(const T& t, const Real*) const {
        const Real a0 = size * t.effective_radius * A::inverse_cbrt(t.effective_radius);
        const Real y2 = t.root / a0, y4 = y2 * y2, y7 = y4 * y2 * A::sqrt(y2);
        return -(pull / 3) * a0 * a0 * (0.8 * y7 + y4 / 15 + 0.4 * std::pow(6.0, -4.0 / 3));
    }

private:
    /// -6^(-1/3)/2: s at the end of a contact.
    static constexpr double least = -0.27516060407455223;

    /// Returns y for s >= least.
    [[gnu::always_inline]] static Real shape(Real s) {
        const Real zero = A::number(0), four_ninths = A::number(4.0 / 9);
        const Real four_s = A::number(4) * s;
        Real m = A::divided(four_ninths, A::number(0.582) + A::larger(four_s, zero)) -
                 A::number(0.4072) * A::smaller(four_s, zero);
        for (int k = 0; k < A::iterations; ++k) {
            const Real square = m * m, slope = A::number(3) * square + four_s;
            const Real left = m * (square + four_s) - four_ninths;
            m = m - A::divided(left * slope, slope * slope - A::number(3) * m * left);
        }
        const Real k = A::sqrt(m);
        return A::number(0.5) * (k + A::sqrt(A::larger(A::divided(A::number(4.0 / 3), k) - m, zero)));
    }
};

inline constexpr std::array surface_energy = {
    fields::quantity<&Material::surface_energy>("surface_energy", "J/m2", "work of adhesion of jkr and dmt", {0, 100})};
inline constexpr Attraction jkr_row{
    "jkr",
    "by surface_energy, Johnson, Kendall & Roberts",
    surface_energy,
    true,
    [](const Material& m, double radius) { return 1.5 * std::numbers::pi * m.surface_energy * (radius / 2); },
    [](const Material& m, const Material& other) {
        return m.cohesion_law != CohesionLaw::jkr || (m.surface_energy > 0) == (other.surface_energy > 0)
                   ? nullptr
                   : "jkr needs surface energy in all contacts or in none: a small one, or dmt, where there is none";
    }};

}  // namespace grainsweep::dem
