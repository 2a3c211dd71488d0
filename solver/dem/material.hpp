// Material parameters of a powder, and derived constants of the contact laws.
//
//     1/E* = 2 (1 - nu^2)/E          1/G* = 4 (2 - nu)(1 + nu)/E         beta = ln e / sqrt(ln^2 e + pi^2)
//
// For one material as above; for two materials
//
//     1/E* = (1 - nu_a^2)/E_a + (1 - nu_b^2)/E_b        1/G* = 2 (2 - nu_a)(1 + nu_a)/E_a + 2 (2 - nu_b)(1 + nu_b)/E_b
//
// Hertz (1882), Mindlin (1949); a linear law has a given stiffness instead (laws/linear.hpp). (Wu 2020, eq. 2, prints
// (1 - nu)^2: a misprint. Gupta, eq. 11, drops the sign of beta, which is negative for e < 1.)
#pragma once

#include "solver/field.hpp"

#include <optional>
#include <span>

namespace grainsweep::dem {

struct Surface;  // walls/wall.hpp

/// Largest number of kinds of spheres with different materials.
inline constexpr unsigned materials_at_most = 8;

/// Law of repulsion: hertz by elastic constants (laws/hertz.hpp), linear by a spring of given stiffness
/// (laws/linear.hpp). All contacts of a case have the same law.
enum class NormalLaw { hertz, linear };

/// Law of attraction, with the words of attractions().
enum class CohesionLaw { sjkr, sjkr2, paper, jkr, dmt, capillary };

/// Normal force in Coulomb's limit: the contact force without the cohesive part, or the net force. An attractive one
/// counts as 0, or with TangentialLimit::spring by its size.
enum class FrictionLimit { contact, net };

/// What Coulomb's limit, and the limit of a rolling moment, holds for (laws/sliding_limit.hpp). sum: spring and dashpot
/// together. spring: the spring alone, as in LIGGGHTS 3.8.
enum class TangentialLimit { sum, spring };

/// Law of rolling resistance, with the words of resistance_rows (laws/compiled.hpp).
enum class RollingLaw { epsd, epsd_liggghts, cdt };

/// Elastic constants of a body.
struct Elasticity {
    double youngs_modulus = 21e6;  ///< Pa
    double poisson_ratio = 0.3;

    bool operator==(const Elasticity&) const = default;
};

/// Material of particles and walls, or of the contact between two materials. The Surface of a wall, or of frozen
/// spheres, may differ in part.
struct Material {
    double youngs_modulus = 21e6;  ///< Pa
    double poisson_ratio = 0.3;
    std::optional<Elasticity> partner{};  ///< of the other body, if it has another material
    NormalLaw normal_law = NormalLaw::hertz;
    double stiffness = 0;                        ///< of the linear law, N/m
    double tangential_ratio = 2.0 / 7;           ///< of the linear law: tangential stiffness divided by normal
                                                 ///< stiffness
    std::optional<double> tangential_damping{};  ///< of the linear law: ratio of the dampers; empty: tangential_ratio
    double density = 7980;                       ///< kg/m3
    double restitution = 0.5;                    ///< (0, 1]
    double friction = 0.2;                       ///< Coulomb, particle-particle and particle-wall; 0: no tangential law
    /// mu_r, tangent of the steepest slope on which a sphere stays at rest, [0, 1]; 0: no rolling resistance
    double rolling_friction = 0;
    RollingLaw rolling_law = RollingLaw::epsd;
    /// eta_r, damping of the rolling spring divided by critical damping, [0, 1]; not for cdt, and only below the
    /// spring's limit. A particle that has stopped rolling oscillates on its spring; 0.3 ends this within about one
    /// period
    double rolling_damping = 0.3;
    double cohesion = 0;          ///< cohesion energy density of sjkr, sjkr2, paper, J/m3; 0: none
    double surface_energy = 0;    ///< w of jkr, dmt: work of adhesion per contact area, J/m2; 0: none
    double surface_tension = 0;   ///< of capillary, N/m; 0: no bridges
    double contact_angle = 0;     ///< of capillary, rad, [0, pi/2)
    double bridge_volume = 2e-4;  ///< of capillary: volume of a bridge divided by the volume of a sphere of its bodies'
                                  ///< harmonic mean radius
    CohesionLaw cohesion_law = CohesionLaw::sjkr;
    FrictionLimit friction_limit = FrictionLimit::contact;
    TangentialLimit tangential_limit = TangentialLimit::sum;

    bool operator==(const Material&) const = default;
};

/// Returns a number of a material.
[[nodiscard]] inline double& part(Material& m, const Field& field) {
    return *static_cast<double*>(field.at(&m));
}
[[nodiscard]] inline const double& part(const Material& m, const Field& field) {
    return part(const_cast<Material&>(m), field);
}

/// Attraction that a file may choose: a row in the file of its law (laws/), listed in laws/compiled.hpp.
struct Attraction {
    std::string_view word, meaning;
    std::span<const Field> members;  ///< that contacts have for it; the first is its amount, 0: no attraction
    bool needs_hertz;
    /// Returns the largest attraction of two equal spheres at rest, N; null: a powder file cannot state this law.
    double (*pull_off)(const Material& m, double radius);
    /// Returns why no case may have this material beside another one of the case; null: it may.
    const char* (*flaw)(const Material& m, const Material& other) = nullptr;
    /// Returns the largest gap over which it acts, m.
    double (*gap)(const Material& m, double effective_radius) = nullptr;

    [[nodiscard]] std::string_view key() const { return members.front().name; }
    [[nodiscard]] auto& amount(auto& m) const { return part(m, members.front()); }
};

/// Rolling law that a file may choose: a row in the file of the law.
struct Resistance {
    std::string_view word, meaning;
    double cost = 1;  ///< time of a step divided by the time without rolling resistance
};

[[nodiscard]] std::span<const Attraction> attractions();
[[nodiscard]] const Attraction& attraction_of(const Material& material);
[[nodiscard]] const Resistance& resistance_of(const Material& material);

/// Returns the members that every pair of materials may state. Defaults: those of standard_contact().
[[nodiscard]] std::span<const Field> contact_fields();
/// Returns the laws, one for all pairs, as fields.
[[nodiscard]] std::span<const Field> law_fields();
/// Returns the contact that a file which states nothing has.
[[nodiscard]] const Material& standard_contact();

[[nodiscard]] double effective_modulus(const Material& material);        ///< E*, Pa
[[nodiscard]] double effective_shear_modulus(const Material& material);  ///< G*, Pa
/// Returns dF_n/dd without damping: for hertz divided by the radius of the contact, 2 E*, Pa; for linear k, N/m.
[[nodiscard]] double normal_slope(const Material& material);
[[nodiscard]] double damping_ratio(double restitution);  ///< beta, <= 0; restitution in (0, 1]
/// Returns -2 sqrt(5/6) beta. A damper of this factor times sqrt(S m*), S = dF/dd, makes restitution independent of the
/// impact speed.
[[nodiscard]] double damping_factor(double restitution);
/// Returns the impulse by which a damped impact attracts at its end, divided by the impulse of the damper in approach;
/// 0 if the tangential limit holds for the spring alone. With z = -beta it is sqrt(e) sinh(z asin(z)/sqrt(1 - z^2))/z:
/// speeds of an impact over its depth are those of a damped oscillator, for Hertz's law over d^(5/4) (Antypov & Elliott
/// (2011), EPL 94, 50004).
[[nodiscard]] double pull_back_share(const Material& material);
[[nodiscard]] double sphere_mass(double radius, double density);  ///< kg

/// Returns the material of contacts with a wall, or frozen spheres, of this surface.
[[nodiscard]] Material at_surface(const Material& material, const Surface& surface);

}  // namespace grainsweep::dem
