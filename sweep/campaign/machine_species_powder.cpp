// "powder" of a species: a powder file becomes its material, sizes and contacts, as if they stood in the machine file.
#include "sweep/campaign/machine_species_powder.hpp"
#include "sweep/campaign/cursor.hpp"
#include "sweep/campaign/powder.hpp"
#include "sweep/campaign/powder_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

namespace grainsweep::campaign {
namespace {

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

}  // namespace

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

}  // namespace grainsweep::campaign
