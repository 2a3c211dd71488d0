// "materials", "contacts" and "walls" of a machine.
#include "sweep/campaign/machine_reading.hpp"

#include "solver/machine/shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace grainsweep::campaign {
namespace {

using machine::Vec3;

/// "glass steel": two of the materials, in any order.
std::pair<std::size_t, std::size_t> materials_of_pair(const Cursor& place, const std::string& name,
                                                      const MachineReading& reading) {
    for (std::size_t a = 0; a < reading.materials.size(); ++a)
        for (std::size_t b = 0; b < reading.materials.size(); ++b)
            if (name == reading.materials[a] + " " + reading.materials[b]) return {a, b};
    std::vector<std::string> pairs;
    for (std::size_t a = 0; a < reading.materials.size(); ++a)
        for (std::size_t b = a; b < reading.materials.size(); ++b)
            pairs.push_back(reading.materials[a] + " " + reading.materials[b]);
    throw input_error(place.path(), "", "a pair is named by two materials with a blank between them",
                      nearest_word(name, pairs));
}

/// Returns the default material of walls: the only material, or the only one without particles.
std::size_t material_of_walls(const Cursor& wall, const MachineReading& reading) {
    std::vector<std::size_t> free;
    for (std::size_t m = 0; m < reading.materials.size(); ++m)
        if (reading.materials.size() == 1 || std::ranges::find(reading.of_particles, m) == reading.of_particles.end())
            free.push_back(m);
    if (free.size() == 1) return free.front();
    throw input_error(wall.path(), "", "key 'material' is missing: several materials could be meant");
}

/// Returns the kinds of particles of all species but those listed, bit by bit.
std::uint8_t all_but(const Cursor& only, const MachineReading& reading) {
    const auto listed = reading.scope.places_in(only, reading.species, "species");
    unsigned passing = (1U << reading.of_particles.size()) - 1;
    for (const std::size_t species : listed) passing &= ~(1U << reading.spec.species[species].material);
    return static_cast<std::uint8_t>(passing);
}

machine::Again read_again(const Section& section, const MachineReading& reading) {
    machine::Again again;
    reading.scope.read(section, machine_keys::again, &again);
    again.each = reading.copies[reading.scope.place_in(section.at("each"), reading.phases, "phase")];
    if (const auto first = section.find("first")) again.first = reading.scope.whole(*first, {0, most_repeats});
    return again;
}

/// Refuses an amount of attraction in a section that the cohesion law does not use. 0 is allowed: a machine may choose
/// the law by a word.
void require_used_attraction(const Section& section, const dem::Material& contact) {
    const dem::Attraction& used = dem::attraction_of(contact);
    for (const dem::Attraction& one : dem::attractions()) {
        const auto place = section.find(one.key());
        if (!place || one.key() == used.key() || !(one.amount(contact) > 0)) continue;
        std::vector<std::string_view> laws;
        for (const dem::Attraction& other : dem::attractions())
            if (other.key() == one.key()) laws.push_back(other.word);
        place->refuse(
            fmt::format("{:.4g} has no effect: it belongs to \"cohesion_law\" {}; that is '{}' here, which uses "
                        "\"{}\"",
                        one.amount(contact), in_words(laws), used.word, used.key()));
    }
}

/// Reads "glued" of "contacts". A property as in other contacts is none of its own.
void read_glued(const Section& contacts, MachineReading& reading, const dem::Material& others) {
    dem::Surface& glued = reading.spec.glued;
    const auto place = reading.scope.read(contacts, "glued", &glued);
    if (place && reading.of_particles.size() > 1)
        place->place().refuse("glued particles differ by their material if there are several");
    if (place) require_used_attraction(*place, dem::at_surface(others, glued));
    const auto keep = [](std::optional<double>& own, double other) {
        if (own == other) own.reset();
    };
    keep(glued.restitution, others.restitution), keep(glued.friction, others.friction);
    keep(glued.rolling_friction, others.rolling_friction), keep(glued.cohesion, others.cohesion);
    keep(glued.surface_energy, others.surface_energy);
}

}  // namespace

void read_materials(const Section& top, MachineReading& reading) {
    const Cursor all = top.at("materials");
    if (!all.json().is_object() || all.json().empty()) all.refuse("must be an object of materials by name");
    for (const auto& [name, value] : all.json().items()) {
        const Cursor place = all[name];
        require_name(place, name);
        const Section section(place, machine_keys::material);
        reading.materials.push_back(name);
        auto& elasticity = reading.elasticities.emplace_back();
        reading.scope.read(section, machine_keys::material, &elasticity);
        elasticity.youngs_modulus *= reading.stiffness_scale;
        reading.densities.push_back(reading.scope.number(section, "density", "kg/m3", 0, positive_number));
    }
}

void read_contacts(const Section& top, MachineReading& reading) {
    dem::Material standard = dem::standard_contact();
    std::vector<std::vector<std::optional<Cursor>>> own(reading.materials.size(),
                                                        std::vector<std::optional<Cursor>>(reading.materials.size()));
    if (const auto place = top.find("contacts")) {
        const Section section(*place, machine_keys::contacts());
        reading.scope.read(section, machine_keys::contacts(), &standard);
        require_used_attraction(section, standard);
        read_glued(section, reading, standard);
        if (const auto pairs = section.find("pairs")) {
            if (!pairs->json().is_object()) pairs->refuse("must be an object of pairs: \"glass steel\"");
            for (const auto& [name, value] : pairs->json().items()) {
                const Cursor pair = (*pairs)[name];
                const auto [a, b] = materials_of_pair(pair, name, reading);
                if (own[a][b]) pair.refuse("this pair is there twice");
                own[a][b] = own[b][a] = pair;
            }
        }
    }
    const std::size_t count = reading.materials.size();
    reading.contacts.assign(count, std::vector<dem::Material>(count));
    for (std::size_t a = 0; a < count; ++a)
        for (std::size_t b = 0; b < count; ++b) {
            dem::Material contact = standard;
            if (own[a][b]) {
                const Section pair(*own[a][b], dem::contact_fields());
                reading.scope.read(pair, dem::contact_fields(), &contact);
                require_used_attraction(pair, contact);
            }
            const bool linear = contact.normal_law == dem::NormalLaw::linear;
            if (linear != (contact.stiffness > 0))
                throw input_error(top.find("contacts")->path(), "",
                                  fmt::format("between {} and {}: {}", reading.materials[a], reading.materials[b],
                                              linear ? "key 'stiffness' is missing: the linear law needs it"
                                                     : "'stiffness' belongs to \"normal_law\": \"linear\""));
            contact.stiffness *= reading.stiffness_scale;
            contact.youngs_modulus = reading.elasticities[a].youngs_modulus;
            contact.poisson_ratio = reading.elasticities[a].poisson_ratio;
            if (reading.elasticities[a] != reading.elasticities[b]) contact.partner = reading.elasticities[b];
            reading.contacts[a][b] = contact;
        }
    settle_rolling_of_shapes(top, reading);
    auto& spec = reading.spec;
    for (std::size_t b = 0; b < reading.of_particles.size(); ++b)
        for (std::size_t a = 0; a <= b; ++a)
            spec.pairs.push_back(reading.contacts[reading.of_particles[a]][reading.of_particles[b]]);
    if (spec.pairs.size() == 1) spec.pairs.front().density = spec.densities.front();
}

void read_walls(const Section& top, MachineReading& reading) {
    const auto all = top.find("walls");
    if (!all) return;
    if (!all->json().is_object()) all->refuse("must be an object of walls by name");
    for (const auto& [name, value] : all->json().items()) {
        const Cursor place = (*all)[name];
        require_name(place, name);
        const Section section(place, machine_keys::wall());
        reading.walls.push_back(name);
        auto& numbers = reading.repeats.emplace_back();
        for_every_one(section, reading, [&](std::int64_t k, std::int64_t count) {
            if (reading.scope.present(section)) {
                machine::MachineWall wall{count > 1 ? fmt::format("{}_{}", name, k + 1) : name,
                                          read_shape(section, reading),
                                          {},
                                          {},
                                          read_during(section, reading)};
                if (const auto motions = section.find("motion"))
                    for (const auto& one : motions->elements())
                        for_every_one(Section(one, machine_keys::motion()), reading, [&](std::int64_t, std::int64_t) {
                            if (one.json().is_object() && one.json().contains("follow")) {
                                for (auto& piece : read_follow(Section(one, machine_keys::motion()), reading))
                                    wall.motions.push_back(std::move(piece));
                                return;
                            }
                            read_motion(one, reading, wall);
                        });
                const auto material = section.find("material");
                const std::size_t of = material ? reading.scope.place_in(*material, reading.materials, "material")
                                                : material_of_walls(place, reading);
                for (const std::size_t particles : reading.of_particles)
                    wall.materials.push_back(reading.contacts[particles][of]);
                wall.scattered = reading.scope.vector(section, "scattered", "m");
                wall.fitted = section.find("fit").has_value();
                if (const auto again = section.find("again"))
                    wall.again = read_again(Section(*again, machine_keys::again), reading);
                if (const auto only = section.find("only")) wall.passing = all_but(*only, reading);
                numbers.push_back(reading.spec.walls.size());
                reading.spec.walls.push_back(std::move(wall));
            }
        });
        reading.scope.set_wall(name, numbers.empty() ? std::nullopt : std::optional(numbers.front()));
    }
}

geometry::Shape read_shape(const Section& wall, const MachineReading& reading) {
    const auto& scope = reading.scope;
    const auto types = machine::shape_types();
    const Json& json = wall.place().json();
    const auto stl = wall.find("stl"), listed = wall.find("triangles");
    const Type* type = named_in(json, types);
    const auto stated = std::ranges::count_if(types, [&](const Type& t) { return json.contains(std::string(t.name)); });
    if (stated + (stl ? 1 : 0) + (listed ? 1 : 0) != 1) {
        std::vector<std::string_view> words{"stl", "triangles"};
        for (const Type& t : types) words.push_back(t.name);
        throw input_error(wall.place().path(), "", fmt::format("a wall has one shape: {}", in_words(WordList(words))));
    }
    const Cursor place = stl ? *stl : listed ? *listed : wall.at(type->name);
    machine::StatedShape shape;
    if (type != nullptr) scope.read(Section(place, type->fields), type->fields, type->make(&shape));
    const bool placed = type == nullptr || std::visit([]<class S>(const S&) { return machine::is_flat<S>; }, shape);
    for (const char* key : {"turned", "at"})
        if (const auto given = wall.find(key); given && !placed)
            given->refuse(
                "only stl, triangles, rectangle, perforated, disc and box are placed; other shapes say where they are");
    if (const auto scale = wall.find("scale"); scale && !stl) scale->refuse("only an stl file has a scale");
    const auto fit = wall.find("fit");
    if (fit && !stl) fit->refuse("only an stl file is fitted");
    if (fit && wall.find("turned")) wall.at("turned").refuse("a surface that is fitted is not turned");
    if (const auto angle = wall.find("facet_angle"); angle && type != nullptr)
        angle->refuse("only stl and triangles have facets of a curved surface");

    machine::Placement placement{.at = scope.vector(wall, "at", "m")};
    if (const auto turned = wall.find("turned"))
        scope.read(Section(*turned, machine::placement_fields()), machine::placement_fields(), &placement);
    const double facets = scope.number(wall, "facet_angle", "rad", 0, {0, 0.76});
    try {
        if (fit) {
            const auto mesh =
                machine::fitted_mesh(reading.contents(place), scope.number(wall, "scale", "m", 1, positive_number),
                                     facets, scope.number(*fit, "m", positive_number));
            geometry::TriangleSurface moved = mesh.surface();
            for (auto& corner : moved.corners) corner = geometry::operator+(corner, placement.at);
            return geometry::Mesh(std::move(moved), mesh.one_contact_angle());
        }
        if (stl)
            return machine::stl_mesh(reading.contents(place), scope.number(wall, "scale", "m", 1, positive_number),
                                     facets, placement);
        if (listed) {
            machine::Triangles triangles;
            for (const auto& one : place.elements()) {
                if (!one.json().is_array() || one.json().size() != 3) one.refuse("a triangle has three corners");
                triangles.push_back(
                    {scope.vector(one[std::size_t{0}], "m"), scope.vector(one[1], "m"), scope.vector(one[2], "m")});
            }
            return machine::mesh_of(triangles, facets, placement);
        }
        return std::visit(
            [&]<class S>(const S& s) -> geometry::Shape {
                if constexpr (machine::is_flat<S>)
                    return machine::mesh_of(machine::triangles_of(s), facets, placement);
                else if (const auto flaw = std::string(s.flaw()); !flaw.empty())
                    place.refuse(flaw);
                else
                    return s;
            },
            shape);
    } catch (const std::invalid_argument& why) {
        place.refuse(why.what());
    }
}

}  // namespace grainsweep::campaign
