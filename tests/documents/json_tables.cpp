#include "tests/documents/json_tables.hpp"

#include "tests/documents/table_rows.hpp"
#include "tests/support/places.hpp"
#include "tests/support/process.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace grainsweep::tests {
namespace {

using json = nlohmann::ordered_json;
using Words = std::vector<std::string>;

/// Folder with the campaign of the tables and its database.
const Folder& sample_folder() {
    static const Folder folder;
    static const bool computed = [] {
        folder.write("c.json", R"({"campaign": "c", "scene": "rehearsal",
            "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]}],
            "fixed": {"response": "ishigami", "noise": 0.05},
            "design": {"kind": "halton", "scramble": "random", "sequences": 8, "points": 128},
            "convergence": {"observable": "y", "tolerance": 0.05, "stop": false}})");
        folder.write("old.csv", "x1,x2,y\n0.5,0.25,1\n");
        folder.write("powder.json", R"({"powder": "glass", "material": {"density": 2500},
            "sizes": {"d10": "80 um", "d50": "100 um", "d90": "130 um"}})");
        return run_program({"run", "c.json", "--quiet"}, folder.path()).code == 0;
    }();
    if (!computed) throw std::runtime_error("the campaign of the tables did not run");
    return folder;
}

std::string first_case() {
    const auto listed =
        run_program({"query", "c.db", "--format", "csv", "SELECT min(case_id) FROM sim_case"}, sample_folder().path());
    return listed.out.substr(listed.out.find('\n') + 1, 32);
}

/// Returns the arguments of a command of the tables.
Words arguments_of(const std::string& command) {
    const std::map<std::string, Words> all = {
        {"plan", {"plan", "c.json"}},
        {"run", {"run", "c.json", "--quiet"}},
        {"import", {"import", "old.csv", "c.json", "imported.db"}},
        {"status", {"status", "c.db"}},
        {"explain", {"explain", "c.db", first_case()}},
        {"replay", {"replay", "c.db", first_case()}},
        {"query", {"query", "c.db", "SELECT case_id, scene FROM sim_case LIMIT 1"}},
        {"converge", {"converge", "c.db"}},
        {"sensitivity", {"sensitivity", "c.db"}},
        {"predict", {"predict", "c.db", "--observable", "y", "--at", "x1=0.5", "--at", "x2=0.5"}},
        {"window", {"window", "c.db", "--where", "y > 0", "--maximize", "y"}},
        {"solve", {"solve", "c.json"}},
        {"scenes", {"scenes"}},
        {"scenes NAME", {"scenes", "rehearsal"}},
        {"machines", {"machines"}},
        {"designs", {"designs"}},
        {"designs NAME", {"designs", "halton"}},
        {"report", {"report", "c.db"}},
        {"powder show", {"powder", "show", "powder.json"}}};
    const auto found = all.find(command);
    if (found == all.end()) throw std::invalid_argument("no table of JSON is called '" + command + "'");
    return found->second;
}

/// Keys below these are names that a user chooses.
const std::set<std::string> by_name = {"inputs", "fixed", "scalars", "settings", "series", "profiles", "at"};

struct Keys {
    Words order;  ///< paths
    std::map<std::string, std::set<std::string>> types;

    void add(const std::string& path, const std::string& type) {
        auto& of = types[path];
        if (of.empty()) order.push_back(path);
        of.insert(type);
    }
};

void collect(const json& value, const std::string& path, const std::string& key, Keys& keys) {
    const std::string type = value.is_object()    ? "object"
                             : value.is_array()   ? "list"
                             : value.is_string()  ? "text"
                             : value.is_boolean() ? "true, false"
                             : value.is_number()  ? "number"
                                                  : "null";
    if (!path.empty()) keys.add(path, type);
    if (value.is_array())
        for (const auto& one : value) {
            if (one.is_structured())
                collect(one, path + "[]", key, keys);
            else
                keys.add(path + "[]", one.is_string() ? "text" : one.is_null() ? "null" : "number");
        }
    if (value.is_object())
        for (const auto& [name, inner] : value.items())
            collect(inner, (path.empty() ? "" : path + ".") + (by_name.contains(key) ? "NAME" : name), name, keys);
}

}  // namespace

std::string json_table(const std::string& command) {
    auto arguments = arguments_of(command);
    arguments.insert(arguments.end(), {"--format", "json"});
    const auto ended = run_program(arguments, sample_folder().path());
    Keys keys;
    collect(json::parse(ended.out), "", "", keys);
    std::string table = head({"key", "value"});
    for (const auto& path : keys.order) {
        const auto& types = keys.types[path];
        std::string words;
        for (const auto& type : types)
            if (type != "list" || types.size() > 1) words += (words.empty() ? "" : " or ") + type;
        if (types == std::set<std::string>{"list"}) words = "list";
        table += row({code(path), words});
    }
    return table;
}

}  // namespace grainsweep::tests
