#include "sweep/campaign/machine.hpp"

#include "sweep/campaign/case.hpp"
#include "sweep/campaign/cursor.hpp"
#include "sweep/campaign/machine_parameters.hpp"
#include "sweep/campaign/machine_reading.hpp"
#include "sweep/campaign/powder.hpp"
#include "sweep/campaign/powder_keys.hpp"
#include "sweep/files/whole_file.hpp"

#include "solver/machine/drawing.hpp"
#include "solver/machine/filling.hpp"
#include "solver/machine/setup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

namespace grainsweep::campaign {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t largest_machine_file = 256ULL << 20U;
constexpr std::size_t most_machine_files = 1000;
constexpr double most_steps = 1e12;  // of a phase

// ---- "powder" of a species: its material, sizes and contacts, as if they stood in the machine file

constexpr std::string_view of_walls = "wall_";

/// Sets a value unless the machine file has one itself.
void fill(Json& object, const std::string& key, const Json& value) {
    if (!object.contains(key)) object[key] = value;
}

/// "a b", under the order in which the machine names the pair.
Json& pair_of(Json& pairs, const std::string& a, const std::string& b) {
    const std::string turned = fmt::format("{} {}", b, a);
    return pairs[pairs.contains(turned) ? turned : fmt::format("{} {}", a, b)];
}

Powder powder_named(const Cursor& place, const FileReader& read) {
    const std::string name = place.text();
    try {
        return asked_in(name, [&] { return powder_of(read(name), name, read); });
    } catch (const std::invalid_argument& why) {
        place.refuse(why.what());
    }
}

/// Contacts among the grains, and with every material that no particles are of: as the powder's unless it has its own.
void fill_contacts(Json& document, const std::string& material, const Json& contacts) {
    Json& pairs = document["contacts"]["pairs"];
    std::vector<std::string> walls;
    for (const auto& [name, other] : document["materials"].items())
        if (other.is_object() && !other.contains("density")) walls.push_back(name);
    for (const auto& [key, value] : contacts.items()) {
        if (key == notes_key || key.starts_with(of_walls)) continue;
        fill(pair_of(pairs, material, material), key, value);
        const std::string own = std::string(of_walls) + key;
        for (const auto& wall : walls)
            fill(pair_of(pairs, material, wall), key, contacts.contains(own) ? contacts.at(own) : value);
    }
}

bool may_be_filled(const Json& document, const char* key) {
    return !document.contains(key) || document.at(key).is_object();
}

/// Returns the machine with the powders of its species expanded; values that the machine gives itself have priority.
/// Adds the sizes to `made`, under their names in the returned document. Throws InputError.
Json with_powders(Json document, const std::string& root, const FileReader& read,
                  std::map<std::string, std::string, std::less<>>& made) {
    const bool readable = document.is_object() && document.contains("species") && document.at("species").is_object() &&
                          may_be_filled(document, "materials") && may_be_filled(document, "contacts");
    if (!readable) return document;  // the reader of machines refuses it
    const Json original = document;
    for (const auto& [name, species] : original.at("species").items()) {
        if (!species.is_object() || !species.contains("powder")) continue;
        const Cursor place(species.at("powder"), path_of(path_of(path_of(root, "species"), name), "powder"));
        const Powder powder = powder_named(place, read);
        Json& into = document["species"][name];
        into.erase("powder");
        fill(into, "material", name);
        const Json& material = into["material"];
        if (!material.is_string()) continue;
        if (powder.document->contains("material"))
            for (const auto& [key, value] : powder.document->at("material").items())
                if (key != notes_key) fill(document["materials"][material.get<std::string>()], key, value);
        if (const auto unit = powder.unit()) fill(into, "diameter", *unit);
        if (powder.document->contains("shape")) fill(into, "shape", powder.document->at("shape"));
        if (powder.sizes && !into.contains("sizes")) {
            into["sizes"] = {{"spread", "file"}, {"file", powder.sizes_name()}};
            made[powder.sizes_name()] = powder.sizes->csv;
        }
        if (powder.document->contains("contacts"))
            fill_contacts(document, material.get<std::string>(), powder.document->at("contacts"));
    }
    return document;
}

/// Calls visit(pointer) for every text of the document that names a file: "stl" of walls, "file" in "sizes" of species,
/// "stl" and "spheres" in their "shape", "spheres" of fillings, "file" in their "packing".
template <class Visit>
void for_each_file(const Json& document, const Visit& visit) {
    const auto of = [&](const Json::json_pointer& place) {
        if (document.contains(place) && document.at(place).is_string()) visit(place);
    };
    const auto entries = [&](const char* key) {
        std::vector<Json::json_pointer> all;
        const Json::json_pointer section = Json::json_pointer() / key;
        if (!document.contains(key) || !document.at(key).is_structured()) return all;
        if (document.at(key).is_array())
            for (std::size_t k = 0; k < document.at(key).size(); ++k) all.push_back(section / k);
        else
            for (const auto& [name, value] : document.at(key).items()) all.push_back(section / name);
        return all;
    };
    for (const auto& wall : entries("walls")) of(wall / "stl");
    for (const auto& species : entries("species")) {
        of(species / "sizes" / "file");
        of(species / "shape" / "stl");
        // Beside an stl it is a number, or an expression.
        if (!document.contains(species / "shape" / "stl")) of(species / "shape" / "spheres");
    }
    for (const auto& fill : entries("fill")) of(fill / "spheres"), of(fill / "packing" / "file");
}

/// "/walls/shell/stl" as a place for messages.
Cursor cursor_at(const Json& document, const std::string& root, const Json::json_pointer& place) {
    Json::json_pointer rest = place;
    std::vector<std::string> keys;
    for (; !rest.empty(); rest.pop_back()) keys.push_back(rest.back());
    Cursor cursor(document, root);
    for (auto key = keys.rbegin(); key != keys.rend(); ++key)
        cursor = cursor.json().is_array() ? cursor[std::stoul(*key)] : cursor[*key];
    return cursor;
}

/// Returns all texts that a text with "{NAME}" can become, in the order of the words; none if a case names the file.
std::vector<std::string> expansions(const std::string& text, const std::vector<ParameterSpec>& parameters) {
    const std::size_t open = text.find('{'), close = text.find('}', open);
    if (open == std::string::npos || close == std::string::npos) return {text};
    const std::string braced = text.substr(open, close - open + 1);
    std::vector<std::string> all;
    for (const auto& parameter : parameters) {
        const auto* words = std::get_if<Words>(&parameter.bounds);
        if (words == nullptr || "{" + parameter.name + "}" != braced || words->file_allowed) continue;
        for (const auto& word : words->allowed) {
            std::string one = text;
            for (std::size_t at = open; at != std::string::npos; at = one.find(braced, at))
                one.replace(at, braced.size(), word);
            for (auto& expanded : expansions(one, parameters)) all.push_back(std::move(expanded));
        }
    }
    return all;
}

/// Without "notes" and "$schema", wherever a section has them; no name is "notes".
Json without_notes(const Json& value) {
    if (!value.is_structured()) return value;
    Json all = value.is_array() ? Json::array() : Json::object();
    for (const auto& [name, inner] : value.items()) {
        if (value.is_array())
            all.push_back(without_notes(inner));
        else if (name != notes_key && name != schema_key)
            all[name] = without_notes(inner);
    }
    return all;
}

/// Returns the machine without the parts that change no answer; files as hashes of their contents.
Json answering_part(const Machine& machine) {
    Json identity = *machine.document;
    for_each_file(*machine.document, [&](const Json::json_pointer& place) {
        Json hashes = Json::array();
        for (const auto& name : expansions(machine.document->at(place).get<std::string>(), machine.parameters))
            hashes.push_back(content_hash(machine.files.find(name)->second));
        identity[place] = std::move(hashes);
    });
    identity.erase("name"), identity.erase("summary"), identity.erase("main"), identity.erase("shown"),
        identity.erase("accuracy");
    if (identity.contains("parameters"))
        for (auto& parameter : identity["parameters"])
            parameter.erase("meaning"), parameter.erase("bounds"), parameter.erase("above");
    if (identity.contains("checks"))
        for (auto& check : identity["checks"])
            for (const char* words : {"refuse", "warn", "that"})
                if (check.contains(words)) check[words] = "";
    for (auto& measure : identity["measure"])
        if (measure.is_object()) measure.erase("meaning");
    return without_notes(identity);
}

machine::Vec3 gravity_of(const Section& top, const MachineScope& scope) {
    const auto place = top.find("gravity");
    if (!place) return {0, 0, -9.81};
    if (!place->json().is_object()) return scope.vector(*place, "m/s2");
    const Section section(*place, machine_keys::gravity);
    const double size = scope.number(section.at("size"), "m/s2", {0, 1e6});
    const double tilt = scope.number(section, "tilt", "rad", 0), azimuth = scope.number(section, "azimuth", "rad", 0);
    return {size * std::sin(tilt) * std::cos(azimuth), size * std::sin(tilt) * std::sin(azimuth),
            0 - size * std::cos(tilt)};
}

/// Warns of plain numbers that were meant as degrees: no machine is tilted by more than a turn.
void warn_of_degrees(const Section& top, machine::Spec& spec) {
    const auto look = [&](const Cursor& object, const char* key) {
        if (!object.json().is_object() || !object.json().contains(key) || !object.json().at(key).is_number()) return;
        const Cursor place = object[key];
        const double angle = place.json().get<double>();
        if (std::abs(angle) > 2 * std::numbers::pi)
            spec.warnings.push_back(
                {"an angle beyond a turn",
                 fmt::format("{0}: {1:.4g} rad are {2:.4g} degrees; write \"{1:.4g} deg\" for degrees", place.path(),
                             angle, angle * 180 / std::numbers::pi)});
    };
    if (const auto gravity = top.find("gravity")) look(*gravity, "tilt"), look(*gravity, "azimuth");
    if (const auto walls = top.find("walls"))
        for (const auto& [name, wall] : walls->members("must be an object of walls by name"))
            if (wall.json().is_object() && wall.json().contains("turned")) look(wall["turned"], "angle");
}

double input_number(const Inputs& inputs, std::string_view name) {
    return std::get<double>(inputs.find(name)->second);
}

/// `phases`: their path.
void set_time_step(machine::Spec& spec, const Inputs& inputs, const std::vector<std::string>& phase_paths) {
    spec.method.precision = std::get<std::string>(inputs.find("precision")->second) == "double"
                                ? dem::Method::Precision::double_precision
                                : dem::Method::Precision::mixed;
    spec.time_step = input_number(inputs, "time_step");
    const double longest =
        machine::time_step_of(spec, 1, spec.impact_speed ? *spec.impact_speed : machine::fastest_of(spec));
    if (spec.time_step > longest)
        throw input_error("time_step", fmt::format("{:.4g}", spec.time_step),
                          fmt::format("must be at most {:.4g} s, the shortest Rayleigh time or contact time of these "
                                      "particles, or what the spring of a wall allows",
                                      longest));
    if (!(spec.time_step > 0)) machine::take_own_step(spec, input_number(inputs, "time_step_fraction"), longest);
    for (std::size_t p = 0; p < spec.phases.size(); ++p)
        if (spec.phases[p].duration > most_steps * spec.time_step)
            throw input_error(
                phase_paths[p], fmt::format("{:.4g} s", spec.phases[p].duration),
                fmt::format("a phase has at most {:.0e} time steps, here of {:.4g} s", most_steps, spec.time_step));
}

machine::Spec spec_of(const Section& top, const Machine& machine, const Inputs& inputs, const Files& files) {
    std::map<std::string, std::string_view, std::less<>> named(machine.files.begin(), machine.files.end());
    for (const auto& [parameter, contents] : files)
        named.insert_or_assign(std::get<std::string>(inputs.find(parameter)->second), contents);
    MachineReading reading(machine_scope(top, machine.parameters, inputs, named), machine.observables);
    reading.particles_scale = input_number(inputs, "particles_scale");
    reading.stiffness_scale = input_number(inputs, stiffness_parameter);
    if (takes_ratio(*machine.document)) reading.aspect_ratio = input_number(inputs, ratio_parameter);
    reading.spec.gravity = gravity_of(top, reading.scope);
    if (!machine.unused.empty())
        reading.spec.warnings.push_back(
            {"parameters that nothing uses",
             fmt::format("nothing in this machine uses {}: as a factor it changes nothing", in_words(machine.unused))});
    read_phase_names(top, reading);
    (void)reading.scope.read(top, "shaking", &reading.spec.shaking);
    reading.spec.method.rest_speed = reading.scope.number(top, "rest_speed", "m/s", 0, no_negative_number);
    read_materials(top, reading);
    read_species(top, reading);
    add_species_numbers(top, reading.spec, reading.scope);
    read_checks(top, reading);
    read_contacts(top, reading);
    read_walls(top, reading);
    warn_of_degrees(top, reading.spec);
    read_fills(top, reading);
    read_removals(top, reading);
    read_feeds(top, reading);
    read_measures(top, reading);
    read_phases(top, reading);
    check_motions(top, reading);
    if (reading.spec.fills.empty() && reading.spec.feeds.empty())
        throw input_error(top.place().path(), "", "a machine needs particles: \"fill\" or \"feed\"");
    read_surroundings(top, reading);
    if (const auto speed = top.find("impact_speed"))
        reading.spec.impact_speed = reading.scope.number(*speed, "m/s", positive_number);
    try {
        set_time_step(reading.spec, inputs, reading.phase_paths);
    } catch (const std::invalid_argument& why) {  // walls that cannot be in this domain
        throw input_error(top.place().path(), "", why.what());
    }
    try {
        machine::require_out_of_walls(reading.spec);
    } catch (const std::invalid_argument& why) {
        throw input_error(top.at("fill").path(), "", why.what());
    }
    return std::move(reading.spec);
}

/// Returns the machine of a document. No case of it is checked: one in a database was checked when it was written,
/// maybe by fewer rules.
std::shared_ptr<const Machine> read_document(Json document, const std::string& root, const FileReader& read_file) {
    auto machine = std::make_shared<Machine>();
    machine->document = std::make_shared<const Json>(std::move(document));
    if (machine->document->is_object() && machine->document->contains("campaign"))
        throw input_error(root, "", "this is a campaign file, not a machine file; its key \"machine\" names one");
    const Section top(Cursor(*machine->document, root), machine_keys::top());
    machine->name = top.at("name").text();
    require_name(top.at("name"), machine->name);
    const auto summary = top.find("summary");
    machine->summary = summary ? summary->text() : machine->name;
    machine->parameters = read_machine_parameters(top);
    machine->unused = unused_parameters(top.place().json(), machine->parameters);
    machine->accuracy = read_machine_accuracy(top, machine->parameters);
    machine->observables = machine_observables(top);
    machine->shown = shown_observables(top);
    for_each_file(*machine->document, [&](const Json::json_pointer& pointer) {
        const Cursor place = cursor_at(*machine->document, root, pointer);
        for (const auto& name : expansions(place.text(), machine->parameters)) {
            if (machine->files.contains(name)) continue;
            if (machine->files.size() == most_machine_files)
                place.refuse(fmt::format("a machine has at most {} files", most_machine_files));
            try {
                machine->files[name] = read_file(name);
            } catch (const std::invalid_argument& why) {
                place.refuse(why.what());
            }
        }
    });
    return machine;
}

/// Refuses a machine whose case of defaults is none.
void check_defaults(const Machine& machine, const std::string& root) {
    Inputs defaults;
    for (const auto& parameter : machine.parameters) defaults.emplace(parameter.name, parameter.default_value);
    (void)spec_of(Section(Cursor(*machine.document, root), machine_keys::top()), machine, defaults, {});
}

}  // namespace

std::shared_ptr<const Machine> make_machine(Json document, std::string root, const FileReader& read_file) {
    std::map<std::string, std::string, std::less<>> made;
    document = with_powders(std::move(document), root, read_file, made);
    auto machine = read_document(std::move(document), root, [&](const std::string& name) {
        const auto found = made.find(name);
        return found == made.end() ? read_file(name) : found->second;
    });
    check_defaults(*machine, root);
    return machine;
}

FileReader beside(const fs::path& folder) {
    return [folder](const std::string& name) {
        std::error_code error;
        std::string contents = files::whole_file(folder / name, error, largest_machine_file);
        if (error)
            throw std::invalid_argument(
                fmt::format("the file '{}' beside it cannot be read: {}", name, error.message()));
        return contents;
    };
}

bool is_machine_document(const Json& document) {
    return document.is_object() && !document.contains("campaign") && document.contains("phases");
}

std::shared_ptr<const Machine> read_machine(const fs::path& file) {
    std::error_code error;
    const std::string text = files::whole_file(file, error, largest_machine_file);
    if (error)
        throw input_error(file.string(), "", fmt::format("the machine file cannot be read: {}", error.message()));
    return asked_in(file, [&] { return make_machine(parse_json(text), "$", beside(file.parent_path())); });
}

machine::Spec machine_spec(const Machine& machine, const Inputs& inputs, const Files& files) {
    return asked_in(machine.name, [&] {
        return spec_of(Section(Cursor(*machine.document, "$"), machine_keys::top()), machine, inputs, files);
    });
}

std::string machine_scene_name(const Machine& machine) {
    return std::string(machine_prefix) + content_hash(answering_part(machine).dump());
}

std::string machine_text(const Machine& machine) {
    Json files = Json::object();
    for (const auto& [name, contents] : machine.files) files[name] = content_hash(contents);
    return Json{{"machine", *machine.document}, {"files", files}}.dump();
}

std::shared_ptr<const Machine> machine_in(std::string_view text, const FileReader& contents_of_hash) {
    try {
        const Json definition = parse_json(text);
        const Json& files = definition.at("files");
        return read_document(definition.at("machine"), "$", [&](const std::string& name) {
            return contents_of_hash(files.at(name).get<std::string>());
        });
    } catch (const Json::exception& error) {
        throw std::invalid_argument(fmt::format("no definition of a machine: {}", error.what()));
    } catch (const InputError& wrong) {
        throw std::invalid_argument(fmt::format("no definition of a machine: {}", wrong.what()));
    }
}

std::string draw_machine(const Machine& machine, const Inputs& inputs, std::int64_t frames,
                         const std::function<void(const Snapshot&, double time)>& show) {
    const auto spec = machine_spec(machine, inputs);
    std::string why_empty;
    machine::Filled filled;
    try {
        filled = machine::filled(spec, 1);
    } catch (const std::invalid_argument& why) {
        why_empty = why.what();
    }
    try {
        const double end = machine::longest_time(spec);
        for (std::int64_t k = 0; k < frames; ++k) {
            const double time = end * static_cast<double>(k) / static_cast<double>(frames - 1);
            show(machine::drawing(spec, filled, time), time);
        }
    } catch (const std::invalid_argument& why) {
        throw InputError(machine.name + ": " + why.what());
    }
    return why_empty;
}

}  // namespace grainsweep::campaign
