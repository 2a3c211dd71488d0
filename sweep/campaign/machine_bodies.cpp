// "materials", "contacts" and "walls" of a machine.
#include "sweep/campaign/machine_reading.hpp"

#include "solver/machine/shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace grainsweep::campaign {
namespace {

using machine::Vec3;

constexpr std::size_t most_repeats = 1000;

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
    throw wrong_question(place.path(), "", "a pair is named by two materials with a blank between them",
                         nearest_word(name, pairs));
}

void read_values(const Section& section, const MachineScope& scope, dem::Material& contact) {
    contact.restitution = scope.number(section, "restitution", "1", contact.restitution, {0, 1, true, false});
    contact.friction = scope.number(section, "friction", "1", contact.friction, {0, 10});
    contact.rolling_friction = scope.number(section, "rolling_friction", "1", contact.rolling_friction, {0, 1});
    contact.rolling_damping = scope.number(section, "rolling_damping", "1", contact.rolling_damping, {0, 1});
    contact.stiffness = scope.number(section, "stiffness", "N/m", contact.stiffness, positive_number);
    contact.tangential_ratio =
        scope.number(section, "tangential_ratio", "1", contact.tangential_ratio, {0, 1, true, false});
    contact.cohesion = scope.number(section, "cohesion", "J/m3", contact.cohesion, {0, 1e9});
    contact.surface_energy = scope.number(section, "surface_energy", "J/m2", contact.surface_energy, {0, 100});
    contact.surface_tension = scope.number(section, "surface_tension", "N/m", contact.surface_tension, {0, 10});
    contact.contact_angle =
        scope.number(section, "contact_angle", "rad", contact.contact_angle, {0, std::numbers::pi / 2, false, true});
    contact.bridge_volume =
        scope.number(section, "bridge_volume", "1", contact.bridge_volume, {0, dem::largest_bridge, true, false});
}

template <class Enum>
Enum law_of(const Section& section, const MachineScope& scope, std::string_view key, Enum standard) {
    const auto place = section.find(key);
    if (!place) return standard;
    const auto table = machine_keys::contacts();
    const auto words = std::ranges::find(table, key, &Key::name)->words;
    const auto chosen = scope.word(*place, words);
    return static_cast<Enum>(std::ranges::find(words, chosen) - words.begin());
}

/// Returns the default material of walls: the only material, or the only one without particles.
std::size_t material_of_walls(const Cursor& wall, const MachineReading& reading) {
    std::vector<std::size_t> free;
    for (std::size_t m = 0; m < reading.materials.size(); ++m)
        if (reading.materials.size() == 1 || std::ranges::find(reading.of_particles, m) == reading.of_particles.end())
            free.push_back(m);
    if (free.size() == 1) return free.front();
    throw wrong_question(wall.path(), "", "key 'material' is missing: several materials could be meant");
}

/// Calls `read` with the number of a copy and the number of copies, for every copy that "repeat" makes. Within it the
/// counter "as" is known.
template <class Read>
void for_every_one(const Section& section, MachineReading& reading, Read read) {
    const auto repeat = section.find("repeat"), as = section.find("as");
    if (as && !repeat) as->refuse("without \"repeat\" it has no effect");
    const std::int64_t count = repeat ? reading.scope.whole(*repeat, {0, most_repeats}) : 1;
    MachineScope outer = reading.scope;
    for (std::int64_t k = 0; k < count; ++k) {
        if (as) {
            const std::string counter = as->text();
            require_name(*as, counter);
            if (counter == "pi" || outer.knows(counter)) as->refuse("a parameter or \"let\" has this name");
            reading.scope.set(counter, static_cast<double>(k));
        }
        read(k, count);
        reading.scope = outer;
    }
}

}  // namespace

void read_materials(const Section& top, MachineReading& reading) {
    const Cursor all = top.at("materials");
    if (!all.json().is_object() || all.json().empty()) all.refuse("must be an object of materials by name");
    for (const auto& [name, value] : all.json().items()) {
        const Cursor place = all[name];
        require_name(place, name);
        const Section section(place, machine_keys::material());
        reading.materials.push_back(name);
        const double modulus = reading.scope.number(section.at("youngs_modulus"), "Pa", {1e3, 1e13});
        reading.elasticities.push_back(
            {modulus * reading.stiffness_scale, reading.scope.number(section, "poisson_ratio", "1", 0.3, {0, 0.49})});
        reading.densities.push_back(reading.scope.number(section, "density", "kg/m3", 0, positive_number));
    }
}

void read_contacts(const Section& top, MachineReading& reading) {
    dem::Material standard;
    standard.friction = 0.5;
    std::vector<std::vector<std::optional<Cursor>>> own(reading.materials.size(),
                                                        std::vector<std::optional<Cursor>>(reading.materials.size()));
    if (const auto place = top.find("contacts")) {
        const Section section(*place, machine_keys::contacts());
        read_values(section, reading.scope, standard);
        standard.rolling_law = law_of(section, reading.scope, "rolling_law", standard.rolling_law);
        standard.cohesion_law = law_of(section, reading.scope, "cohesion_law", standard.cohesion_law);
        standard.normal_law = law_of(section, reading.scope, "normal_law", standard.normal_law);
        standard.friction_limit = law_of(section, reading.scope, "friction_limit", standard.friction_limit);
        standard.tangential_limit = law_of(section, reading.scope, "tangential_limit", standard.tangential_limit);
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
            if (own[a][b]) read_values(Section(*own[a][b], machine_keys::pair()), reading.scope, contact);
            const bool linear = contact.normal_law == dem::NormalLaw::linear;
            if (linear != (contact.stiffness > 0))
                throw wrong_question(top.find("contacts")->path(), "",
                                     fmt::format("between {} and {}: {}", reading.materials[a], reading.materials[b],
                                                 linear ? "key 'stiffness' is missing: the linear law needs it"
                                                        : "'stiffness' belongs to \"normal_law\": \"linear\""));
            if (contact.surface_tension > 0 && contact.cohesion_law != dem::CohesionLaw::capillary)
                throw wrong_question(top.find("contacts")->path(), "",
                                     "'surface_tension' belongs to \"cohesion_law\": \"capillary\"");
            contact.stiffness *= reading.stiffness_scale;
            contact.youngs_modulus = reading.elasticities[a].youngs_modulus;
            contact.poisson_ratio = reading.elasticities[a].poisson_ratio;
            if (reading.elasticities[a] != reading.elasticities[b]) contact.partner = reading.elasticities[b];
            reading.contacts[a][b] = contact;
        }
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
                            bool acts = true;
                            auto motion = read_motion(one, reading, wall, acts);
                            if (acts && !geometry::is_still(motion.motion)) wall.motions.push_back(std::move(motion));
                        });
                const auto material = section.find("material");
                const std::size_t of = material ? reading.scope.place_in(*material, reading.materials, "material")
                                                : material_of_walls(place, reading);
                for (const std::size_t particles : reading.of_particles)
                    wall.materials.push_back(reading.contacts[particles][of]);
                numbers.push_back(reading.spec.walls.size());
                reading.spec.walls.push_back(std::move(wall));
            }
        });
    }
}

geometry::Shape read_shape(const Section& wall, const MachineReading& reading) {
    const auto& scope = reading.scope;
    const auto forms = machine_keys::shapes();
    const Json& json = wall.place().json();
    const int meshes = static_cast<int>(json.contains("stl")) + static_cast<int>(json.contains("triangles"));
    const auto form = form_of(json, forms);
    const bool several =
        !form && std::ranges::any_of(forms, [&](const auto& f) { return json.contains(std::string(f.name)); });
    if (several || meshes + static_cast<int>(form.has_value()) != 1) {
        std::vector<std::string_view> words{"stl", "triangles"};
        for (const auto& f : forms) words.push_back(f.name);
        throw wrong_question(wall.place().path(), "",
                             fmt::format("a wall has one shape: {}", in_words(WordList(words))));
    }
    const bool flat =
        meshes == 1 ||
        (form && (forms[*form].name == "rectangle" || forms[*form].name == "disc" || forms[*form].name == "box"));
    for (const char* key : {"turned", "at"})
        if (const auto place = wall.find(key); place && !flat)
            place->refuse("only stl, triangles, rectangle, disc and box are placed; other shapes say where they are");
    if (const auto scale = wall.find("scale"); scale && !wall.find("stl"))
        scale->refuse("only an stl file has a scale");
    if (const auto angle = wall.find("facet_angle"); angle && meshes == 0)
        angle->refuse("only stl and triangles have facets of a curved surface");

    if (flat) {
        machine::Placement placement{.at = scope.vector(wall, "at", "m")};
        if (const auto turned = wall.find("turned")) {
            const Section of(*turned, machine_keys::turned());
            placement.axis = scope.direction(of.at("axis"));
            placement.angle = scope.number(of.at("angle"), "rad");
            placement.through = scope.vector(of, "through", "m");
        }
        const double facets = scope.number(wall, "facet_angle", "rad", 0, {0, 0.76});
        const Cursor place =
            meshes == 1 ? (wall.find("stl") ? wall.at("stl") : wall.at("triangles")) : wall.at(forms[*form].name);
        try {
            if (wall.find("stl"))
                return machine::stl_mesh(reading.contents(place), scope.number(wall, "scale", "m", 1, positive_number),
                                         facets, placement);
            std::vector<std::array<Vec3, 3>> triangles;
            if (meshes == 1) {
                for (const auto& one : place.elements()) {
                    if (!one.json().is_array() || one.json().size() != 3) one.refuse("a triangle has three corners");
                    triangles.push_back(
                        {scope.vector(one[std::size_t{0}], "m"), scope.vector(one[1], "m"), scope.vector(one[2], "m")});
                }
            } else {
                const Section of(place, forms[*form].keys);
                if (forms[*form].name == "rectangle")
                    triangles =
                        machine::rectangle(scope.vector(of.at("corner"), "m"), scope.vector(of.at("along"), "m"),
                                           scope.vector(of.at("across"), "m"));
                if (forms[*form].name == "disc")
                    triangles = machine::disc(scope.vector(of, "centre", "m"), scope.direction(of, "normal", {0, 0, 1}),
                                              scope.number(of.at("radius"), "m", positive_number),
                                              scope.number(of, "inner", "m", 0, no_negative_number));
                if (forms[*form].name == "box") {
                    constexpr std::array<std::string_view, 6> faces = {"-x", "+x", "-y", "+y", "-z", "+z"};
                    std::array<bool, 6> open{};
                    if (const auto list = of.find("open"))
                        for (const auto& face : list->elements())
                            open[static_cast<std::size_t>(std::ranges::find(faces, scope.word(face, faces)) -
                                                          faces.begin())] = true;
                    triangles = machine::box(scope.vector(of.at("low"), "m"), scope.vector(of.at("high"), "m"), open);
                }
            }
            return machine::mesh_of(triangles, facets, placement);
        } catch (const std::invalid_argument& why) {
            place.refuse(why.what());
        }
    }

    const std::string_view name = forms[*form].name;
    const Cursor place = wall.at(name);
    const Section of(place, forms[*form].keys);
    const auto length = [&](std::string_view key) { return scope.number(of.at(key), "m"); };
    const auto side = [&] {
        return scope.word(of, "side", std::array<std::string_view, 2>{"inside", "outside"}, "inside") == "inside"
                   ? geometry::Side::inside
                   : geometry::Side::outside;
    };
    geometry::Shape shape;
    if (name == "plane") shape = geometry::Plane{scope.vector(of, "point", "m"), scope.direction(of.at("normal"))};
    if (name == "cylinder")
        shape = geometry::Cylinder{scope.vector(of, "point", "m"), scope.direction(of, "axis", {0, 0, 1}),
                                   length("radius"), side(), scope.number(of, "length", "m", endless, positive_number)};
    if (name == "cone")
        shape = geometry::Cone{scope.vector(of.at("base"), "m"),
                               scope.direction(of, "axis", {0, 0, 1}),
                               length("base_radius"),
                               length("end_radius"),
                               length("length"),
                               side()};
    if (name == "tube")
        shape = geometry::Tube{scope.vector(of.at("base"), "m"), scope.direction(of, "axis", {0, 0, 1}),
                               length("inner"), length("outer"), length("length")};
    if (name == "bar")
        shape = geometry::Bar{.front = length("front"),
                              .thickness = length("thickness"),
                              .bottom = length("bottom"),
                              .top = length("top"),
                              .edge_radius = scope.number(of, "edge_radius", "m", 0)};
    const std::string flaw = std::visit([](const auto& s) { return std::string(s.flaw()); }, shape);
    if (!flaw.empty()) place.refuse(flaw);
    return shape;
}

}  // namespace grainsweep::campaign
