#include "solver/dem/material.hpp"

#include "solver/dem/walls/wall.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace grainsweep::dem {
namespace {

constexpr std::array<std::string_view, 3> rolling_words = {"epsd", "epsd_liggghts", "cdt"};
constexpr std::array<std::string_view, 6> cohesion_words = {"sjkr", "sjkr2", "paper", "jkr", "dmt", "capillary"};
constexpr std::array<std::string_view, 2> normal_words = {"hertz", "linear"};
constexpr std::array<std::string_view, 2> limit_words = {"contact", "net"};
constexpr std::array<std::string_view, 2> tangential_words = {"sum", "spring"};

constexpr Field with_standard(Field field, std::string_view standard) {
    field.standard = standard;
    return field;
}

using fields::quantity;
constexpr std::array contact_rows = {
    quantity<&Material::restitution>("restitution", "1", "coefficient of restitution", {0, 1, true, false}),
    quantity<&Material::friction>("friction", "1", "Coulomb friction", {0, 10}),
    quantity<&Material::rolling_friction>("rolling_friction", "1", "tangent of the steepest slope a sphere stands on",
                                          {0, 1}),
    quantity<&Material::rolling_damping>("rolling_damping", "1",
                                         "damping of the rolling spring divided by the critical one", {0, 1}),
    quantity<&Material::stiffness>("stiffness", "N/m", "of the linear law", positive_number),
    with_standard(quantity<&Material::tangential_ratio>(
                      "tangential_ratio", "1",
                      "of the linear law: stiffness of the tangential spring over the normal one", {0, 1, true, false}),
                  "2/7"),
    quantity<&Material::cohesion>("cohesion", "J/m3", "cohesion energy density of sjkr, sjkr2, paper", {0, 1e9}),
    quantity<&Material::surface_energy>("surface_energy", "J/m2", "work of adhesion of jkr and dmt", {0, 100}),
    quantity<&Material::surface_tension>("surface_tension", "N/m", "of the liquid of capillary", {0, 10}),
    quantity<&Material::contact_angle>("contact_angle", "rad", "of the liquid of capillary",
                                       {0, std::numbers::pi / 2, false, true}),
    quantity<&Material::bridge_volume>("bridge_volume", "1",
                                       "of capillary: volume of a liquid bridge divided by that of a sphere of the "
                                       "mean radius 2 R1 R2/(R1 + R2), at a "
                                       "wall of the sphere",
                                       {0, largest_bridge, true, false}),
};
constexpr std::array law_rows = {
    fields::choice<&Material::rolling_law>(
        "rolling_law",
        "how rolling is resisted: epsd by an elastic-plastic spring with a dashpot, epsd_liggghts by the same with "
        "LIGGGHTS 3.8's angle at walls, cdt by a constant torque",
        rolling_words, "\"epsd\""),
    fields::choice<&Material::cohesion_law>(
        "cohesion_law",
        "attraction: cohesion times an area, sjkr cut of the spheres, sjkr2 4 pi R* d, paper pi (2 R* d - d^2)/4; by "
        "surface_energy, jkr Johnson, Kendall & Roberts, dmt Derjaguin, Muller & Toporov; capillary: by liquid bridges",
        cohesion_words, "\"sjkr\""),
    fields::choice<&Material::friction_limit>(
        "friction_limit", "contact: friction of the contact force without cohesion; net: of the net force", limit_words,
        "\"contact\""),
    fields::choice<&Material::tangential_limit>(
        "tangential_limit",
        "sum: friction limits the sum of tangential spring and dashpot; spring: the spring alone, as in LIGGGHTS",
        tangential_words, "\"sum\""),
    fields::choice<&Material::normal_law>("normal_law", "hertz; linear: spring and dashpot of a given stiffness",
                                          normal_words, "\"hertz\""),
};

}  // namespace

std::span<const Field> contact_fields() {
    return contact_rows;
}

std::span<const Field> law_fields() {
    return law_rows;
}

const Material& standard_contact() {
    static const Material contact = [] {
        Material made;
        made.friction = 0.5;
        return made;
    }();
    return contact;
}

double effective_modulus(const Material& m) {
    if (!m.partner) return m.youngs_modulus / (2 * (1 - m.poisson_ratio * m.poisson_ratio));
    const auto compliance = [](double modulus, double ratio) { return (1 - ratio * ratio) / modulus; };
    return 1 / (compliance(m.youngs_modulus, m.poisson_ratio) +
                compliance(m.partner->youngs_modulus, m.partner->poisson_ratio));
}

double effective_shear_modulus(const Material& m) {
    if (!m.partner) return m.youngs_modulus / (4 * (2 - m.poisson_ratio) * (1 + m.poisson_ratio));
    const auto compliance = [](double modulus, double ratio) { return 2 * (2 - ratio) * (1 + ratio) / modulus; };
    return 1 / (compliance(m.youngs_modulus, m.poisson_ratio) +
                compliance(m.partner->youngs_modulus, m.partner->poisson_ratio));
}

double normal_slope(const Material& m) {
    return m.normal_law == NormalLaw::linear ? m.stiffness : 2 * effective_modulus(m);
}

double damping_ratio(double restitution) {
    const double l = std::log(restitution);
    return l / std::hypot(l, std::numbers::pi);
}

double damping_factor(double restitution) {
    return -2 * std::sqrt(5.0 / 6.0) * damping_ratio(restitution);
}

double pull_back_share(const Material& m) {
    const double z = -damping_ratio(m.restitution);
    if (m.tangential_limit == TangentialLimit::spring || !(z > 0)) return 0;
    return std::sqrt(m.restitution) * std::sinh(z * std::asin(z) / std::sqrt(1 - z * z)) / z;
}

double sphere_mass(double radius, double density) {
    return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius * density;
}

Material at_surface(const Material& material, const Surface& surface) {
    Material m = material;
    m.friction = surface.friction.value_or(m.friction);
    m.rolling_friction = surface.rolling_friction.value_or(m.rolling_friction);
    m.restitution = surface.restitution.value_or(m.restitution);
    m.cohesion = surface.cohesion.value_or(m.cohesion);
    m.surface_energy = surface.surface_energy.value_or(m.surface_energy);
    return m;
}

}  // namespace grainsweep::dem
