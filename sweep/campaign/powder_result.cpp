#include "sweep/campaign/powder_result.hpp"

#include "sweep/campaign/cursor.hpp"
#include "sweep/campaign/input_error.hpp"
#include "sweep/campaign/powder.hpp"
#include "sweep/campaign/powder_keys.hpp"
#include "sweep/campaign/quantity.hpp"
#include "sweep/files/whole_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>
#include <span>

namespace grainsweep::campaign {
namespace {

namespace fs = std::filesystem;
using OrderedJson = nlohmann::ordered_json;

constexpr std::size_t largest_result_file = 64ULL << 20U;

Json json_in(const fs::path& file) {
    std::error_code error;
    const std::string text = files::whole_file(file, error, largest_result_file);
    return error ? Json() : asked_in(file, [&] { return parse_json(text); });
}

/// Adds the powder files of a campaign, of an experiment or of the species of a machine.
void find_powders(const Json& document, const fs::path& folder, std::set<fs::path>& found) {
    if (!document.is_object()) return;
    if (const auto powder = document.find("powder"); powder != document.end() && powder->is_string())
        found.insert((folder / powder->get<std::string>()).lexically_normal());
    if (const auto species = document.find("species"); species != document.end() && species->is_object())
        for (const auto& one : *species) find_powders(one, folder, found);
    if (const auto machine = document.find("machine"); machine != document.end()) {
        if (machine->is_object()) find_powders(*machine, folder, found);
        if (machine->is_string()) {
            const fs::path file = folder / machine->get<std::string>();
            std::error_code none;
            if (fs::is_regular_file(file, none)) find_powders(json_in(file), file.parent_path(), found);
        }
    }
    if (const auto calibration = document.find("calibration");
        calibration != document.end() && calibration->is_object())
        if (const auto all = calibration->find("experiments"); all != calibration->end() && all->is_object())
            for (const auto& one : *all) find_powders(one, folder, found);
}

bool is_key_of(std::span<const Field> keys, const std::string& name) {
    return std::ranges::find(keys, std::string_view(name), &Field::name) != keys.end();
}

/// The object of a powder file that holds a parameter; empty: the parameter is of no powder.
const char* object_of(const std::string& name) {
    if (is_key_of(powder_keys::material, name)) return "material";
    return is_key_of(powder_keys::contacts(), name) ? "contacts" : "";
}

/// A number, a word of a law, or a quantity; expressions are of the campaign.
bool is_plain_value(const Json& value, const std::string& name) {
    if (value.is_number()) return true;
    if (!value.is_string()) return false;
    const auto& parameter = powder_parameter(name);
    if (std::holds_alternative<std::string>(parameter.default_value)) return true;
    return std::holds_alternative<double>(in_si(value.get<std::string>(), parameter.unit));
}

/// Sets what the campaign fixes itself; returns the names.
std::vector<std::string> set_fixed(const Json& document, OrderedJson& into) {
    std::vector<std::string> names;
    const auto fixed = document.find("fixed");
    if (fixed == document.end() || !fixed->is_object()) return names;
    for (const auto& [name, value] : fixed->items()) {
        const std::string object = object_of(name);
        if (object.empty() || !is_plain_value(value, name)) continue;
        into[object][name] = value;
        names.push_back(name);
    }
    const auto diameter = fixed->find("diameter");
    const bool plain = diameter != fixed->end() && (diameter->is_number() || diameter->is_string());
    const auto distribution = fixed->value("size_distribution", Json("monodisperse"));
    if (plain && !into.contains("sizes") && distribution == "monodisperse") {
        into["sizes"] = {{"diameter", *diameter}};
        names.emplace_back("diameter");
    }
    return names;
}

OrderedJson measured_number_text(double value, const std::string& unit) {
    if (unit.empty() || unit == "1") return value;
    return fmt::format("{} {}", value, unit);
}

/// Names of the file of sizes beside the powder; copies it where the powder stands in another folder.
void place_sizes(OrderedJson& powder, const std::string& name, const fs::path& base, const fs::path& folder,
                 PowderText& into) {
    if (!powder.contains("sizes") || !powder["sizes"].contains("file")) return;
    const fs::path source = base.parent_path() / powder["sizes"]["file"].get<std::string>();
    std::error_code error;
    if (fs::equivalent(source.parent_path(), folder, error)) {
        powder["sizes"]["file"] = source.filename().string();
        return;
    }
    std::string text = files::whole_file(source, error, largest_result_file);
    if (error) throw input_error("--powder", source.string(), fmt::format("cannot be read: {}", error.message()));
    into.sizes = {name + "_sizes.csv", std::move(text)};
    powder["sizes"]["file"] = into.sizes->first;
}

}  // namespace

PowderText powder_with(const fs::path& config, const std::string& name, const PowderResult& result,
                       const fs::path& folder) {
    const Json document = json_in(config);
    std::set<fs::path> bases;
    find_powders(document, fs::absolute(config).parent_path(), bases);
    OrderedJson powder = {{"powder", name}, {"notes", ""}};
    std::string origin = bases.empty()       ? "no powder file"
                         : bases.size() == 1 ? bases.begin()->filename().string()
                                             : fmt::format("{} powder files, none of them taken", bases.size());
    PowderText text;
    if (bases.size() == 1) {
        (void)read_powder(*bases.begin());  // refuses a file that changed for the worse
        std::error_code error;
        const auto base = OrderedJson::parse(files::whole_file(*bases.begin(), error, largest_result_file));
        for (const char* key : {"material", "sizes", "cut", "contacts", "measured"})
            if (base.contains(key)) powder[key] = base[key];
        if (base.contains("notes") && base["notes"].is_string())
            origin += fmt::format(" ({})", base["notes"].get<std::string>());
        place_sizes(powder, name, *bases.begin(), folder, text);
    }
    for (const char* key : {"material", "contacts"})
        if (!powder.contains(key)) powder[key] = OrderedJson::object();
    const auto fixed = set_fixed(document, powder);
    std::vector<std::string> calibrated;
    for (const auto& [property, value] : result.properties) {
        powder[object_of(property)][property] = value;
        calibrated.push_back(property);
    }
    if (!powder.contains("measured")) powder["measured"] = OrderedJson::array();
    for (const auto& one : result.measured)
        powder["measured"].push_back({{"what", one.what},
                                      {"value", measured_number_text(one.value, one.unit)},
                                      {"error", measured_number_text(one.error, one.unit)},
                                      {"how", "calibration " + name}});
    powder["posterior"] = result.posterior;
    powder["notes"] = fmt::format(
        "Made by grainsweep calibrate from {}: {} at the setting of highest density of the posterior{}.", origin,
        fmt::join(calibrated, ", "),
        fixed.empty() ? ""
                      : fmt::format("; {} from the campaign {}", fmt::join(fixed, ", "), config.filename().string()));
    text.json = powder.dump(1) + "\n";
    return text;
}

}  // namespace grainsweep::campaign
