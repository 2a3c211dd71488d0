#include "sweep/campaign/machine.hpp"

#include "sweep/campaign/case.hpp"
#include "sweep/campaign/machine_parameters.hpp"
#include "sweep/campaign/machine_reading.hpp"
#include "sweep/files/whole_file.hpp"

#include "solver/machine/setup.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <set>
#include <stdexcept>

namespace grainsweep::campaign {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t largest_machine_file = 256ULL << 20U;

/// Names of files in the document: of "stl", of "file" in "sizes", of "spheres".
void find_files(const Json& value, const std::string& key, std::set<std::string>& into) {
    if (value.is_string() && (key == "stl" || key == "file" || key == "spheres")) into.insert(value.get<std::string>());
    if (!value.is_structured()) return;
    for (const auto& [name, inner] : value.items()) find_files(inner, value.is_object() ? name : "", into);
}

/// All texts that a text with "{NAME}" can become.
std::vector<std::string> expansions(const std::string& text, const std::vector<ParameterSpec>& parameters) {
    const std::size_t open = text.find('{'), close = text.find('}', open);
    if (open == std::string::npos || close == std::string::npos) return {text};
    std::vector<std::string> all;
    for (const auto& parameter : parameters) {
        const auto* words = std::get_if<Words>(&parameter.bounds);
        if (words == nullptr || parameter.name != text.substr(open + 1, close - open - 1)) continue;
        for (const auto& word : words->allowed)
            for (auto& one : expansions(text.substr(0, open) + word + text.substr(close + 1), parameters))
                all.push_back(std::move(one));
    }
    return all;
}

/// Without what changes no answer; files by the hash of their contents.
Json answering_part(const Json& value, const std::string& key, const Machine& machine) {
    if (value.is_string() && (key == "stl" || key == "file" || key == "spheres")) {
        const auto file = machine.files.find(value.get<std::string>());
        return file == machine.files.end() ? value : Json(content_hash(file->second));
    }
    if (value.is_array()) {
        Json list = Json::array();
        for (const auto& inner : value) list.push_back(answering_part(inner, "", machine));
        return list;
    }
    if (!value.is_object()) return value;
    Json object = Json::object();
    for (const auto& [name, inner] : value.items())
        if (name != notes_key && name != "meaning" && name != "bounds")
            object[name] = answering_part(inner, name, machine);
    return object;
}

machine::Vec3 gravity_of(const Section& top, const MachineScope& scope) {
    const auto place = top.find("gravity");
    if (!place) return {0, 0, -9.81};
    if (!place->json().is_object()) return scope.vector(*place, "m/s2");
    const Section section(*place, machine_keys::gravity());
    const double size = scope.number(section.at("size"), "m/s2", {0, 1e6});
    const double tilt = scope.number(section, "tilt", "rad", 0), azimuth = scope.number(section, "azimuth", "rad", 0);
    return {size * std::sin(tilt) * std::cos(azimuth), size * std::sin(tilt) * std::sin(azimuth),
            0 - size * std::cos(tilt)};
}

double input_number(const Inputs& inputs, std::string_view name) {
    return std::get<double>(inputs.find(name)->second);
}

void set_time_step(machine::Spec& spec, const Inputs& inputs) {
    spec.method.precision = std::get<std::string>(inputs.find("precision")->second) == "double"
                                ? dem::Method::Precision::double_precision
                                : dem::Method::Precision::mixed;
    spec.time_step = input_number(inputs, "time_step");
    if (!(spec.time_step > 0))
        spec.time_step =
            machine::time_step_of(spec, input_number(inputs, "time_step_fraction"), machine::fastest_of(spec));
}

machine::Spec spec_of(const Section& top, const Machine& machine, const Inputs& inputs) {
    MachineReading reading(machine.files, machine_scope(top, machine.parameters, inputs));
    reading.particles_scale = input_number(inputs, "particles_scale");
    reading.spec.gravity = gravity_of(top, reading.scope);
    read_phase_names(top, reading);
    read_materials(top, reading);
    read_species(top, reading);
    read_contacts(top, reading);
    read_walls(top, reading);
    read_fills(top, reading);
    read_feeds(top, reading);
    read_measures(top, reading);
    read_phases(top, reading);
    if (reading.spec.fills.empty() && reading.spec.feeds.empty())
        throw wrong_question(top.place().path(), "", "a machine needs particles: \"fill\" or \"feed\"");
    read_surroundings(top, reading);
    set_time_step(reading.spec, inputs);
    return std::move(reading.spec);
}

std::shared_ptr<const Machine> checked(Json document, const std::string& root, const FileReader& read_file) {
    auto machine = std::make_shared<Machine>();
    machine->document = std::make_shared<const Json>(std::move(document));
    const Section top(Cursor(*machine->document, root), machine_keys::top());
    machine->name = top.at("name").text();
    require_name(top.at("name"), machine->name);
    const auto summary = top.find("summary");
    machine->summary = summary ? summary->text() : machine->name;
    machine->parameters = read_machine_parameters(top);
    machine->observables = machine_observables(top);
    std::set<std::string> named;
    find_files(*machine->document, "", named);
    for (const auto& text : named)
        for (const auto& name : expansions(text, machine->parameters)) machine->files[name] = read_file(name);
    Inputs defaults;
    for (const auto& parameter : machine->parameters) defaults.emplace(parameter.name, parameter.default_value);
    (void)spec_of(top, *machine, defaults);
    return machine;
}

}  // namespace

const std::string& MachineReading::contents(const Cursor& place) const {
    const std::string name = scope.text(place);
    const auto found = files.find(name);
    if (found == files.end()) place.refuse(fmt::format("there is no file '{}'", name));
    return found->second;
}

std::shared_ptr<const Machine> make_machine(Json document, std::string root, const FileReader& read_file) {
    return checked(std::move(document), root, read_file);
}

FileReader beside(const fs::path& folder) {
    return [folder](const std::string& name) {
        std::error_code error;
        std::string contents = files::whole_file(folder / name, error, largest_machine_file);
        if (error)
            throw wrong_question("$", name,
                                 fmt::format("the file beside the machine file cannot be read: {}", error.message()));
        return contents;
    };
}

std::shared_ptr<const Machine> read_machine(const fs::path& file) {
    std::error_code error;
    const std::string text = files::whole_file(file, error, largest_machine_file);
    if (error)
        throw wrong_question(file.string(), "", fmt::format("the machine file cannot be read: {}", error.message()));
    return asked_in(file, [&] { return make_machine(parse_json(text), "$", beside(file.parent_path())); });
}

machine::Spec machine_spec(const Machine& machine, const Inputs& inputs) {
    return asked_in(machine.name, [&] {
        return spec_of(Section(Cursor(*machine.document, "$"), machine_keys::top()), machine, inputs);
    });
}

std::string machine_scene_name(const Machine& machine) {
    Json identity = answering_part(*machine.document, "", machine);
    identity.erase("name"), identity.erase("summary");
    return std::string(machine_prefix) + content_hash(identity.dump());
}

std::string machine_text(const Machine& machine) {
    Json files = Json::object();
    for (const auto& [name, contents] : machine.files) files[name] = content_hash(contents);
    return Json{{"machine", *machine.document}, {"files", files}}.dump();
}

std::shared_ptr<const Machine> machine_in(std::string_view text, const FileReader& contents_of_hash) {
    try {
        const Json definition = Json::parse(text);
        const Json& files = definition.at("files");
        return checked(definition.at("machine"), "$",
                       [&](const std::string& name) { return contents_of_hash(files.at(name).get<std::string>()); });
    } catch (const Json::exception& error) {
        throw std::invalid_argument(fmt::format("no definition of a machine: {}", error.what()));
    } catch (const WrongQuestion& wrong) {
        throw std::invalid_argument(fmt::format("no definition of a machine: {}", wrong.what()));
    }
}

}  // namespace grainsweep::campaign
