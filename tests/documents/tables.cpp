// Tables of the documents that repeat what the program knows are generated from it and compared here. To write them
// anew after a change: GRAINSWEEP_WRITE_DOCUMENTS=1 build/tests/test_documents --gtest_filter='Tables.*'
#include "sweep/campaign/field_text.hpp"
#include "sweep/campaign/powder_keys.hpp"
#include "sweep/campaign/reader.hpp"
#include "sweep/store/store.hpp"
#include "tests/documents/command_tables.hpp"
#include "tests/documents/json_tables.hpp"
#include "tests/documents/machine_tables.hpp"
#include "tests/documents/measured_tables.hpp"
#include "tests/documents/page.hpp"
#include "tests/documents/table_rows.hpp"
#include "tests/support/archive.hpp"
#include "tests/support/peer_suites.hpp"
#include "tests/support/places.hpp"
#include "tests/support/process.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>
#include <stdexcept>

namespace grainsweep::tests::tables_test {

using nlohmann::ordered_json;

/// What the program answers, asked once: reading it takes longer than asking.
const ordered_json& answer_in_json(const std::vector<std::string>& arguments) {
    static std::map<std::vector<std::string>, ordered_json> known;
    const auto [place, asked_now] = known.try_emplace(arguments);
    if (asked_now) place->second = ordered_json::parse(answer_of(arguments));
    return place->second;
}

const ordered_json& catalogue(std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--format", "json"});
    return answer_in_json(arguments);
}

std::string shown(const ordered_json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number_float()) {
        const std::string plain = fmt::format("{}", value.get<double>());
        const std::string short_form = fmt::format("{:g}", value.get<double>());
        return short_form.size() < plain.size() && std::stod(short_form) == value.get<double>() ? short_form : plain;
    }
    return value.dump();
}

std::string words_of(const ordered_json& words) {
    std::string list;
    for (const auto& word : words) list += (list.empty() ? "`" : ", `") + shown(word) + "`";
    return list;
}

/// [low, high], a round bracket where an end is excluded; nothing where an end is open.
std::string bounds_of(const ordered_json& parameter) {
    if (parameter.contains("words"))
        return words_of(parameter["words"]) + (parameter["file_allowed"].get<bool>() ? ", or a file" : "");
    const auto end = [&](const char* name) { return parameter[name].is_null() ? "" : shown(parameter[name]); };
    return fmt::format("{}{}, {}{}", parameter["low_open"].get<bool>() ? "(" : "[", end("low"), end("high"),
                       parameter["high_open"].get<bool>() ? ")" : "]");
}

/// The keys of the section "program": those of observables, or the others.
std::string section_table(const ordered_json& scene, bool of_observables) {
    std::string table = head({"object", "key", "default", "meaning"});
    for (const auto& key : scene["section"]) {
        const std::string object = key["object"];
        if (object.starts_with("observables") != of_observables) continue;
        const std::string standard = key["default"].is_null() ? "" : shown(key["default"]);
        table +=
            row({"`" + object + "`", "`" + shown(key["key"]) + "`",
                 standard.empty() || standard == "required" ? standard : "`" + standard + "`", shown(key["meaning"])});
    }
    return table;
}

std::string parameters_table(const ordered_json& scene) {
    if (scene.contains("section")) return section_table(scene, false);
    std::string table = head({"parameter", "unit", "bounds", "default", "meaning"});
    for (const auto& parameter : scene["parameters"]) {
        std::string meaning = parameter["meaning"];
        std::string only_if;
        for (const auto& condition : parameter["matters_if"])
            only_if += (only_if.empty() ? "" : " and ") + shown(condition);
        if (!only_if.empty()) meaning += fmt::format(" (only if {})", only_if);
        table += row({"`" + shown(parameter["name"]) + "`", shown(parameter["unit"]), bounds_of(parameter),
                      shown(parameter["default"]), meaning});
    }
    return table;
}

const std::set<std::string>& common_to_machines() {
    static const std::set<std::string> common = {
        "aspect_ratio",       "particles_scale", "stiffness_scale", "time_step",
        "time_step_fraction", "precision",       "particles",       "lost",
        "max_overlap",        "max_wall_overlap"};
    return common;
}

/// Parameters that every machine has.
std::string common_parameters() {
    const auto& declared = catalogue({"machines", "chute"});
    ordered_json common;
    for (const auto& one : declared["parameters"])
        if (common_to_machines().contains(one["name"])) common["parameters"].push_back(one);
    return parameters_table(common);
}

/// What a machine declares itself, without what every machine has.
ordered_json own_part_of_machine(const std::string& name, const std::string& part) {
    const auto& declared = catalogue({"machines", name});
    const auto& other = catalogue({"machines", "chute"})[part];
    ordered_json own = ordered_json::array();
    for (const auto& one : declared[part]) {
        const std::string what = one["name"];
        const bool shared = common_to_machines().contains(what) && std::ranges::any_of(other, [&](const auto& theirs) {
                                return theirs["name"] == one["name"] && theirs["meaning"] == one["meaning"];
                            });
        if (!shared && !what.ends_with("_error")) own.push_back(one);
    }
    ordered_json machine;
    machine[part] = own;
    return machine;
}

/// A machine with a page of its own is documented as a scene, the others together.
bool has_own_page(const std::string& name) {
    return std::filesystem::exists(source("docs/scenes/" + name + ".md"));
}

/// The page of docs/scenes with the section of a machine that has no page of its own.
std::string page_of_section(const std::string& name) {
    for (const char* page : {"machines.md", "conveying.md", "laboratory.md", "laboratory_bulk.md"})
        if (std::filesystem::exists(source(std::string("docs/scenes/") + page)))
            if (read_page(std::string("docs/scenes/") + page).text.find("\n## " + name + "\n") != std::string::npos)
                return page;
    throw std::invalid_argument("no page of docs/scenes has a section of the machine '" + name + "'");
}

/// Of one kind; for docs/scenes/machines.md.
std::string machines_table(const std::string& kind) {
    std::string table = head({"machine", "what it is"});
    for (const auto& machine : catalogue({"machines"})) {
        if (shown(machine["kind"]) != kind) continue;
        const std::string name = shown(machine["machine"]);
        const std::string place = has_own_page(name) ? name + ".md" : page_of_section(name) + "#" + name;
        table += row({fmt::format("[`{}`]({})", name, place), shown(machine["summary"])});
    }
    return table;
}

/// Scenes with a page; for README.md.
std::string scenes_table() {
    std::string table = head({"scene", "what it is"});
    for (const auto& scene : catalogue({"scenes"})) {
        const std::string name = shown(scene["scene"]);
        if (has_own_page(name)) table += row({fmt::format("[{0}](docs/scenes/{0}.md)", name), shown(scene["summary"])});
    }
    return table;
}

/// Ready machines beside LIGGGHTS, by the cases of the reference.
std::string liggghts(std::istream& words) {
    std::vector<std::string> cases;
    for (std::string one; words >> one;) cases.push_back(one);
    std::map<std::pair<std::string, std::string>, std::string> units;
    for (const auto& machine : catalogue({"machines"})) {
        const std::string name = shown(machine["machine"]);
        const auto& declared = catalogue({"machines", name});
        for (const auto& one : declared["observables"]) units[{name, shown(one["name"])}] = shown(one["unit"]);
    }
    return liggghts_table(cases, units);
}

std::string observables_table(const ordered_json& scene) {
    if (scene.contains("section")) return section_table(scene, true);
    std::string table = head({"observable", "unit", "over", "meaning"});
    for (const auto& observable : scene["observables"])
        table += row({"`" + shown(observable["name"]) + "`", shown(observable["unit"]), shown(observable["over"]),
                      shown(observable["meaning"])});
    return table;
}

std::string accuracy_table(const ordered_json& scene) {
    std::string table = head({"accuracy", "inputs"});
    for (const auto& [name, inputs] : scene["accuracy"].items()) {
        std::string list;
        for (const auto& [input, value] : inputs.items())
            list += fmt::format("{}{} = {}", list.empty() ? "" : ", ", input, shown(value));
        table += row({"`" + name + "`", list});
    }
    return table;
}

/// Figures that PeerSuites and slow_peers_suites measured, as they wrote them down.
std::string peers_table() {
    std::string table =
        head({"suite", "one of its figures", "figures", "largest difference divided by its tolerance", "how"});
    for (const auto& cells : peer_rows()) table += row(cells);
    return table;
}

std::string designs_table() {
    std::string table = head({"design", "extends", "what it is good for"});
    for (const auto& design : catalogue({"designs"}))
        table += row({"`" + shown(design["design"]) + "`", shown(design["extends"]), shown(design["summary"])});
    return table;
}

/// The options of every design, under its name.
std::string options_tables() {
    std::string all;
    for (const auto& design : catalogue({"designs"})) {
        const std::string name = shown(design["design"]);
        all += (all.empty() ? "### " : "\n### ") + name + "\n\n" + head({"option", "default", "allowed", "meaning"});
        for (const auto& option : catalogue({"designs", name})["options"])
            all +=
                row({"`" + shown(option["option"]) + "`", option["default"].is_null() ? "" : shown(option["default"]),
                     shown(option["allowed"]), shown(option["meaning"])});
    }
    return all;
}

/// The keys of a powder file, object by object.
std::string powder_keys_table() {
    std::string table = head({"object", "key", "default", "meaning"});
    for (const auto& [object, keys] : campaign::powder_keys::all())
        for (const auto& key : keys)
            table += row({code(std::string(object)), code(std::string(key.name)),
                          key.required ? "required" : code(std::string(key.standard)), campaign::meaning_text(key)});
    return table;
}

/// The keys of one object of the campaign file, as the JSON Schema tells them.
std::string keys_table(const std::string& section) {
    const auto& schema = answer_in_json({"schema"});
    const auto& object =
        section == "campaign" ? schema
        : section == "factor" ? schema["allOf"][0]["then"]["properties"]["factors"]["items"]["oneOf"][0]
        : section == "without_value"
            ? schema["properties"]["calibration"]["properties"]["targets"]["items"]["properties"]["without_value"]
        : section == "target" ? schema["properties"]["calibration"]["properties"]["targets"]["items"]
        : section == "experiment"
            ? schema["properties"]["calibration"]["properties"]["experiments"]["additionalProperties"]
        : section == "accuracy" ? schema["properties"]["accuracy"]["oneOf"][1]
        : section == "stop"     ? schema["properties"]["calibration"]["properties"]["stop"]
                                : schema["properties"][section];
    std::string table = head({"key", "default", "meaning"});
    for (const auto& [name, key] : object["properties"].items()) {
        const bool required =
            object.contains("required") && object["required"].dump().find('"' + name + '"') != std::string::npos;
        // What a key of a factor means is told by the parameter it names.
        std::string meaning =
            section == "factor" && name == "name" ? "a parameter of the scene" : shown(key["description"]);
        if (key.contains("enum")) meaning += "; one of " + words_of(key["enum"]);
        if (key.contains("items") && key["items"].contains("enum")) meaning += "; of " + words_of(key["items"]["enum"]);
        table += row({"`" + name + "`",
                      required                  ? "required"
                      : key.contains("default") ? "`" + key["default"].dump() + "`"
                                                : "",
                      meaning});
    }
    return table;
}

std::string generated(const std::string& what) {
    std::istringstream words(what);
    std::string kind, name, part;
    words >> kind;
    if (kind == "liggghts") return liggghts(words);
    words >> name >> part;
    if (kind == "scene") {
        const auto& scene = catalogue({"scenes", name});
        if (part == "parameters") return parameters_table(scene);
        if (part == "observables") return observables_table(scene);
        if (part == "accuracy") return accuracy_table(scene);
    }
    if (kind == "scenes") return scenes_table();
    if (kind == "measured") return measured_table(name, part == "crossed");
    if (kind == "machines") return name == "common" ? common_parameters() : machines_table(name);
    if (kind == "machine") return name == "keys" ? machine_keys_tables() : machine_table(name);
    if (kind == "ready") {
        const auto machine = own_part_of_machine(name, part);
        return part == "parameters" ? parameters_table(machine) : observables_table(machine);
    }
    if (kind == "json") return json_table(what.substr(std::string_view("json ").size()));
    if (kind == "powder") return powder_keys_table();
    if (kind == "peers") return peers_table();
    if (kind == "designs") return designs_table();
    if (kind == "design") return options_tables();
    if (kind == "keys") return keys_table(name);
    if (kind == "commands") return commands_table();
    if (kind == "command") return command_table(name);
    if (kind == "manual") return manual_table(name == "functions" ? "FUNCTIONS OF QUERY" : "EXIT STATUS");
    throw std::invalid_argument("no table is called '" + what + "'");
}

/// The page with every generated table written anew, and the names of those.
std::pair<std::string, std::vector<std::string>> with_fresh_tables(const std::string& text) {
    static const std::regex marked(R"(<!-- table: ([^>]*) -->\n([^]*?)<!-- end -->)");
    std::string fresh;
    std::vector<std::string> names;
    auto rest = text.cbegin();
    for (std::sregex_iterator it(text.begin(), text.end(), marked), end; it != end; ++it) {
        const std::string what = (*it)[1];
        fresh.append(rest, (*it)[0].first);
        fresh += "<!-- table: " + what + " -->\n\n" + generated(what) + "\n<!-- end -->";
        rest = (*it)[0].second;
        names.push_back(what);
    }
    fresh.append(rest, text.cend());
    return {fresh, names};
}

/// First line in which two texts differ.
std::string difference(const std::string& page, const std::string& fresh) {
    std::istringstream a(page), b(fresh);
    std::string x, y;
    do {
        x.clear();
        y.clear();
        std::getline(a, x);
        std::getline(b, y);
    } while (x == y && (a || b));
    return "the page says:    " + x + "\nthe program says: " + y;
}

TEST(Tables, EqualWhatTheProgramSays) {
    const bool write = std::getenv("GRAINSWEEP_WRITE_DOCUMENTS") != nullptr;
    for (const auto& page : user_pages()) {
        const auto [fresh, names] = with_fresh_tables(page.text);
        if (write && fresh != page.text) std::ofstream(page.path(), std::ios::binary) << fresh;
        if (!write) {
            EXPECT_TRUE(page.text == fresh) << page.file << "\n" << difference(page.text, fresh);
        }
    }
}

TEST(Tables, EverySceneHasItsPage) {
    std::string all;
    for (const auto& page : user_pages())
        for (const auto& name : with_fresh_tables(page.text).second) all += name + '\n';
    std::set<std::string> machines;
    for (const auto& machine : catalogue({"machines"})) machines.insert(shown(machine["machine"]));
    for (const auto& scene : catalogue({"scenes"})) {
        const std::string name = shown(scene["scene"]);
        if (name == "machine") continue;  // its parameters are those of a file: the reference of machines
        if (machines.contains(name) && !has_own_page(name)) continue;
        EXPECT_NE(all.find("scene " + name + " parameters\n"), std::string::npos) << name;
        EXPECT_NE(all.find("scene " + name + " observables\n"), std::string::npos) << name;
        const auto page = read_page("docs/scenes/" + name + ".md");
        EXPECT_TRUE(page.text.starts_with("# " + name + "\n")) << name;
        EXPECT_NE(page.text.find("## What it cannot do\n"), std::string::npos) << name;
        EXPECT_NE(page.text.find("](" + name + ".svg)"), std::string::npos) << name << " has no drawing";
    }
}

TEST(Tables, EveryInstalledMachineHasItsSectionAndItsPicture) {
    EXPECT_NE(read_page("docs/machines_reference.md").text.find("## What it cannot do\n"), std::string::npos);
    for (const auto& machine : catalogue({"machines"})) {
        const std::string name = shown(machine["machine"]);
        if (has_own_page(name)) continue;
        const auto page = read_page("docs/scenes/" + page_of_section(name));
        const auto names = with_fresh_tables(page.text).second;
        EXPECT_NE(page.text.find("](../pictures/machine_" + name + ".png)"), std::string::npos) << name;
        for (const char* part : {" parameters", " observables"})
            EXPECT_NE(std::ranges::find(names, "ready " + name + part), names.end()) << name << part;
    }
}

TEST(Tables, EveryCommandHasItsArgumentsAndItsJson) {
    const auto names = with_fresh_tables(read_page("docs/commands.md").text).second;
    const auto results = with_fresh_tables(read_page("docs/json.md").text).second;
    for (const auto& command : command_names()) {
        EXPECT_NE(std::ranges::find(names, "command " + command), names.end()) << command;
        if (command == "serve" || command == "schema") continue;  // prints nothing; prints a schema
        EXPECT_TRUE(std::ranges::any_of(results, [&](const auto& name) {
            return (name + " ").starts_with("json " + command + " ");
        })) << command;
    }
}

/// docs/database.md names the columns of a view whose names meet as the view does.
TEST(Tables, SuffixesOfColumnsAreThoseOfAView) {
    namespace campaign = grainsweep::campaign;
    const Folder folder;
    const std::string text = R"({"campaign": "c", "scene": "program",
        "program": {"command": ["cat"], "protocol": "lines", "observables": {"y": {}, "Mass": {}}},
        "factors": [{"name": "Seed", "between": [0, 1]}, {"name": "y", "between": [0, 1]}, {"name": "mass", "levels": [1]}],
        "design": {"kind": "halton", "points": 4}})";
    folder.write("c.json", text);
    const auto asked = campaign::read_campaign(folder.path() / "c.json");
    grainsweep::store::Store store(folder.path() / "a.db", grainsweep::store::Store::Mode::create);
    store.enrol(asked, {}, grainsweep::tests::here());
    const auto columns = store.query("SELECT * FROM c").columns;
    const std::vector<std::string> named(columns.begin() + 8, columns.end());
    EXPECT_EQ(named, (std::vector<std::string>{"Seed_input", "y", "mass", "Mass_observed", "y_observed"}));
    const auto text_of_page = read_page("docs/database.md").text;
    for (const char* suffix : {"gets `_input`: `seed_input`", "gets `_observed`: `y_observed`"})
        EXPECT_NE(text_of_page.find(suffix), std::string::npos) << suffix;
}

}  // namespace grainsweep::tests::tables_test
