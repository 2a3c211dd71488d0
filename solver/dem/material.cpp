#include "solver/dem/material.hpp"

#include "solver/dem/laws/compiled.hpp"
#include "solver/dem/walls/wall.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

namespace grainsweep::dem {
namespace {

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
};

/// Returns the field of a law; its words, in the order of the enumeration, and their meanings are those of the rows.
template <auto member, class Row>
Field law_of(std::span<const Row> rows, std::string_view name, std::string_view begins, std::string_view standard) {
    static std::vector<std::string_view> words;
    static std::string meaning(begins);
    for (const Row& row : rows) {
        meaning.append(words.empty() ? " " : "; ").append(row.word).append(" ").append(row.meaning);
        words.push_back(row.word);
    }
    return fields::choice<member>(name, meaning, words, standard);
}

/// Returns the row of a law, which a damaged checkpoint may have falsified.
const auto& chosen_row(const auto& rows, std::size_t law) {
    if (law >= rows.size()) throw std::invalid_argument("a material has a law that does not exist");
    return rows[law];
}

constexpr std::array other_laws = {
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

std::span<const Attraction> attractions() {
    return attraction_rows;
}

const Attraction& attraction_of(const Material& m) {
    return chosen_row(attraction_rows, static_cast<std::size_t>(m.cohesion_law));
}

const Resistance& resistance_of(const Material& m) {
    return chosen_row(resistance_rows, static_cast<std::size_t>(m.rolling_law));
}

std::span<const Field> contact_fields() {
    static const auto all = [] {
        std::vector<Field> fields(contact_rows.begin(), contact_rows.end());
        for (const Attraction& one : attractions())
            if (std::ranges::find(fields, one.key(), &Field::name) == fields.end())
                fields.insert(fields.end(), one.members.begin(), one.members.end());
        return fields;
    }();
    return all;
}

std::span<const Field> law_fields() {
    static const std::vector<Field> all = {
        law_of<&Material::rolling_law, Resistance>(resistance_rows, "rolling_law",
                                                   "how rolling is resisted:", "\"epsd\""),
        law_of<&Material::cohesion_law, Attraction>(attraction_rows, "cohesion_law", "attraction:", "\"sjkr\""),
        other_laws[0], other_laws[1], other_laws[2]};
    return all;
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
