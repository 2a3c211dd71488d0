#include "sweep/campaign/powder_keys.hpp"

#include "sweep/campaign/powder_export.hpp"

#include "solver/dem/material.hpp"

#include <algorithm>
#include <array>

namespace grainsweep::campaign::powder_keys {
namespace {

using PowderKind = Field::Kind;

constexpr auto top_keys = std::to_array<Field>({
    needed({"powder", PowderKind::text, "name of the powder"}),
    {"material", PowderKind::object, "density and stiffness"},
    {"sizes", PowderKind::object, "how diameters are distributed"},
    {"cut", PowderKind::object, "sizes that are left out: what a sieve or a classifier takes away"},
    {"contacts", PowderKind::object, "how particles touch each other and walls"},
    {"shape", PowderKind::object,
     "of the grains, as of a species in a machine file; of it a scene takes aspect_ratio alone, if it has this "
     "parameter"},
    {"measured", PowderKind::array, "what was measured of the powder; for readers"},
    {"posterior", PowderKind::text, "CSV file of settings that a calibration found, beside the powder file"},
});

constexpr std::array material_keys = {
    fields::quantity<&dem::Material::density>("density", "kg/m3", "density of the particles", {100, 25000}),
    fields::quantity<&dem::Material::youngs_modulus>("youngs_modulus", "Pa", "Young's modulus", {1e5, 1e12}),
    fields::quantity<&dem::Material::poisson_ratio>("poisson_ratio", "1", "Poisson's ratio", {0, 0.49}),
};

constexpr auto contact_keys = std::to_array<Field>({
    {"restitution", PowderKind::value, "coefficient of restitution"},
    {"friction", PowderKind::value, "Coulomb friction"},
    {"rolling_friction", PowderKind::value, "tangent of the steepest slope a sphere stands on"},
    {"rolling_law", PowderKind::text, "how rolling is resisted, as in the scenes"},
    {"tangential_limit", PowderKind::text, "form of the limit of friction, as in the scenes"},
    {"cohesion_law", PowderKind::text, "attraction, as in the scenes"},
    {"wall_friction", PowderKind::value, "Coulomb friction at walls"},
    {"wall_rolling_friction", PowderKind::value, "rolling friction at walls"},
    {"wall_restitution", PowderKind::value, "restitution at walls"},
    {"wall_cohesion", PowderKind::value, "cohesion energy density at walls, J/m3"},
    {"wall_surface_energy", PowderKind::value, "work of adhesion at walls, J/m2"},
});

constexpr auto size_keys = std::to_array<Field>({
    {"file", PowderKind::text, "a CSV file of sizes, as size_file of the scenes and as powder import writes"},
    {"diameter", PowderKind::value, "all particles are equal, m"},
    {"d10", PowderKind::value,
     "10 % are smaller; with d50 and d90: two half lognormal distributions through the three, m"},
    {"d50", PowderKind::value, "half is smaller, m"},
    {"d90", PowderKind::value, "90 % are smaller, m"},
    {"lognormal", PowderKind::object, "by median and sigma or ratio"},
    {"rosin_rammler", PowderKind::object, "share above d: exp(-(d/d63)^n)"},
    {"by", PowderKind::word, "what the shares are of; of a file its header says it", "\"volume\"", {}, export_by},
});

constexpr auto lognormal_keys = std::to_array<Field>({
    needed({"median", PowderKind::value, "half is smaller, m"}),
    {"sigma", PowderKind::value, "standard deviation of ln d"},
    {"ratio", PowderKind::value, "or its exponential: the geometric standard deviation"},
});

constexpr auto rosin_rammler_keys = std::to_array<Field>({
    needed({"d63", PowderKind::value, "63.2 % are smaller, m"}),
    needed({"n", PowderKind::value, "exponent"}),
});

constexpr auto cut_keys = std::to_array<Field>({
    {"below", PowderKind::value, "what is smaller is left out, m"},
    {"above", PowderKind::value, "what is larger is left out, m"},
});

constexpr auto measured_keys = std::to_array<Field>({
    needed({"what", PowderKind::text, "the quantity"}),
    needed({"value", PowderKind::value, "number, or text with a unit"}),
    {"error", PowderKind::value, "standard error"},
    {"how", PowderKind::text, "method or standard"},
});

}  // namespace

constinit const std::span<const Field> top = top_keys;
constinit const std::span<const Field> material = material_keys;
std::span<const Field> contacts() {
    static const auto keys = [] {
        std::vector<Field> all(contact_keys.begin(), contact_keys.end());
        for (const Field& field : dem::contact_fields())
            if (std::ranges::any_of(dem::attractions(), [&](const dem::Attraction& one) {
                    return one.pull_off != nullptr && one.key() == field.name;
                }))
                all.push_back({field.name, PowderKind::value, field.meaning, {}, {}, {}, false, field.unit});
        return all;
    }();
    return keys;
}
constinit const std::span<const Field> sizes = size_keys;
constinit const std::span<const Field> lognormal = lognormal_keys;
constinit const std::span<const Field> rosin_rammler = rosin_rammler_keys;
constinit const std::span<const Field> cut = cut_keys;
constinit const std::span<const Field> measured = measured_keys;

std::vector<std::pair<std::string_view, std::span<const Field>>> all() {
    return {{"powder", top},  {"material", material},   {"contacts", contacts()},
            {"sizes", sizes}, {"lognormal", lognormal}, {"rosin_rammler", rosin_rammler},
            {"cut", cut},     {"measured", measured}};
}

}  // namespace grainsweep::campaign::powder_keys
