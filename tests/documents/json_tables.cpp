#include "tests/documents/json_tables.hpp"

#include "sweep/campaign/field_text.hpp"
#include "sweep/report/results/catalogues.hpp"
#include "sweep/report/results/runs.hpp"
#include "sweep/report/results/study.hpp"
#include "tests/documents/table_rows.hpp"
#include "tests/support/places.hpp"
#include "tests/support/process.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

namespace grainsweep::tests::json_tables_test {

namespace results = report::results;
using json = nlohmann::ordered_json;
using Words = std::vector<std::string>;
using Fields = std::span<const Field>;

/// Folder with the campaigns of the samples and their databases.
const Folder& sample_folder() {
    static const Folder folder;
    static const bool computed = [] {
        folder.write("c.json", R"({"campaign": "c", "scene": "rehearsal",
            "factors": [{"name": "x1", "between": [0, 1]}, {"name": "x2", "between": [0, 1]}],
            "fixed": {"response": "ishigami", "noise": 0.05},
            "design": {"kind": "halton", "scramble": "random", "sequences": 8, "points": 128},
            "convergence": {"observable": "y", "tolerance": 0.05, "stop": false}})");
        folder.write("refined.json", R"({"campaign": "refined", "scene": "rehearsal",
            "factors": [{"name": "x2", "levels": [0.11, 0.61]}, {"name": "x3", "between": [0, 1]}],
            "fixed": {"response": "spreading_b", "x1": 0.4, "x4": 0.6, "noise": 0.2},
            "design": {"kind": "refine", "factor": "x3", "observable": "y", "threshold": 0.05, "width": 0.1}})");
        folder.write("fit.json", R"({"campaign": "fit",
            "factors": [{"name": "x1", "levels": [0.1, 0.9]}, {"name": "x2", "between": [0, 1]}],
            "calibration": {
                "experiments": {"a": {"scene": "rehearsal", "fixed": {"response": "spreading_a", "noise": 0.02}},
                                "b": {"scene": "rehearsal", "fixed": {"response": "spreading_a", "x4": 0.2}}},
                "targets": [{"of": "a", "observable": "y", "value": 0.237, "error": 0.01, "inputs": {"x3": 0.5}},
                            {"of": "b", "observable": "y", "value": 0.4, "error": 0.01, "inputs": {"x3": 0.9}}],
                "discrepancy": {"a": {"y": 0.001}, "b": {"y": 0.001}}, "waves": 2, "points_per_wave": 16}})");
        folder.write("morris.json", R"({"campaign": "morris", "scene": "rehearsal",
            "factors": [{"name": "x1", "normal": {"mean": 0.5, "sd": 0.1}},
                        {"name": "x2", "between": [0, 1], "step": 0.001}],
            "fixed": {"response": "ishigami"},
            "design": {"kind": "morris", "trajectories": 4}})");
        folder.write("deck.txt", "y = {{ x }}{{ step }}\n");
        folder.write("goal.json", R"json({"campaign": "goal", "scene": "program",
            "program": {"command": ["cat", "deck.txt"], "templates": ["deck.txt"], "parameters": {"x": {}, "step": {}},
                "observables": {"y": {"from": {"output": "y = ([0-9.]+)"}}},
                "accuracy": {"coarse": {"step": 1, "cost_seconds": 1}, "fine": {"step": 2, "cost_seconds": 9},
                             "reference": "fine"}},
            "factors": [{"name": "x", "between": [0.1, 0.9]}],
            "design": {"kind": "halton", "sequences": 8, "points": 128},
            "accuracy": {"observable": "y", "gates": ["mean"], "tolerance": 0.05}})json");
        std::string facets;
        for (const char* corners : {"0 0 0,0 1 0,1 0 0", "0 0 0,1 0 0,0 0 1", "0 0 0,0 0 1,0 1 0", "1 0 0,0 1 0,0 0 1"})
            facets += fmt::format("facet normal 0 0 0 outer loop vertex {} vertex {} vertex {} endloop endfacet\n",
                                  std::string_view(corners, 5), std::string_view(corners + 6, 5), corners + 12);
        folder.write("grain.stl", "solid grain\n" + facets + "endsolid grain\n");
        folder.write("old.csv", "x1,x2,y\n0.5,0.25,1\n");
        folder.write("export.csv", "size (um),passing (%)\n50,0\n80,10\n100,50\n130,90\n200,100\n");
        folder.write("powder.json", R"({"powder": "glass", "material": {"density": 2500},
            "sizes": {"d10": "80 um", "d50": "100 um", "d90": "130 um"}})");
        return std::ranges::all_of(Words{"c", "refined", "fit", "goal"}, [&](const auto& name) {
            return run_program({"run", name + ".json", "--quiet"}, folder.path()).code <= 1;
        });
    }();
    if (!computed) throw std::runtime_error("the campaigns of the samples did not run");
    return folder;
}

/// "CASE" of the arguments: the first case of a database.
std::string first_case(const std::string& database) {
    const auto listed = run_program({"query", database, "--format", "csv", "SELECT min(case_id) FROM sim_case"},
                                    sample_folder().path());
    return listed.out.substr(listed.out.find('\n') + 1, 32);
}

/// Result of a command: its fields, and samples of it.
struct Output {
    std::string_view name;
    Fields fields;
    bool list = false;  ///< a list of such objects
    std::vector<Words> samples = {};
};

const std::vector<Output>& outputs() {
    static const std::vector<Output> all = {
        {"plan", results::plan, false, {{"plan", "c.json"}, {"plan", "morris.json", "--probe"}}},
        {"run", results::run, false, {{"run", "c.json", "--quiet"}}},
        {"calibrate", results::run, false, {{"calibrate", "fit.json", "--quiet"}}},
        {"work", results::work, false, {{"work", "c.json", "--spool", "shared", "--quiet"}}},
        {"collect", results::run, false, {{"collect", "collected.db", "shared", "--quiet"}}},
        {"import", results::import, false, {{"import", "old.csv", "c.json", "imported.db"}}},
        {"status", results::status, true, {{"status", "c.db"}}},
        {"explain", results::explain, false, {{"explain", "c.db", "CASE"}, {"explain", "goal.db", "CASE"}}},
        {"replay", results::replay, false, {{"replay", "c.db", "CASE"}}},
        {"query", results::query_row, true, {{"query", "c.db", "SELECT case_id, scene FROM sim_case LIMIT 1"}}},
        {"dump", results::dump_line, true, {{"dump", "c.db"}}},
        {"verify", results::damage, true, {{"verify", "c.db"}}},
        {"converge", results::converge, true, {{"converge", "c.db"}, {"converge", "goal.db", "--campaign", "goal"}}},
        {"converge crossings", results::crossings, true, {{"converge", "refined.db"}}},
        {"converge calibration", results::calibration, true, {{"converge", "fit.db", "--campaign", "fit_a"}}},
        {"converge beside", results::calibration_beside, true, {{"converge", "fit.db", "--campaign", "fit_b"}}},
        {"sensitivity",
         results::sensitivity,
         true,
         {{"sensitivity", "c.db"}, {"sensitivity", "goal.db", "--campaign", "goal"}}},
        {"report", results::report_file, false, {{"report", "c.db"}}},
        {"figure", results::listed_figure, true, {{"figure", "c.db"}}},
        {"figure NAME", results::figure_file, false, {{"figure", "c.db", "effects", "-o", "effects.svg"}}},
        {"predict",
         results::predict,
         false,
         {{"predict", "c.db", "--observable", "y", "--at", "x1=0.5", "--at", "x2=0.5"}}},
        {"window",
         results::window,
         false,
         {{"window", "c.db", "--where", "y > 0", "--maximize", "y", "--next", "1"},
          {"window", "c.db", "--where", "y > 0", "--maximize", "y", "--minimize", "x1", "--hold", "x2=0.5"}}},
        {"accuracy", results::accuracy, false, {{"accuracy", "goal.json", "--points", "4", "--quiet"}}},
        {"solve", results::solve, false, {{"solve", "c.json"}, {"solve", "goal.json"}}},
        {"draw", results::drawing, false, {{"draw", "chute", "-o", "chute.html", "--frames", "2"}}},
        {"powder show", results::powder, false, {{"powder", "show", "powder.json"}}},
        {"powder import",
         results::powder_import,
         false,
         {{"powder", "import", "export.csv", "--by", "volume", "-o", "sizes.csv"}}},
        {"shape", results::shape_number, true, {{"shape", "grain.stl", "--spheres", "2", "-o", "grain.csv"}}},
        {"scenes", results::listed_scene, true, {{"scenes"}}},
        {"scenes NAME", results::scene, false, {{"scenes", "rehearsal"}, {"scenes", "program"}}},
        {"machines", results::listed_machine, true, {{"machines"}}},
        {"machines NAME", results::scene, false, {{"machines", "chute"}}},
        {"designs", results::listed_design, true, {{"designs"}}},
        {"designs NAME", results::design, false, {{"designs", "halton"}}},
        {"completion", results::completion, true, {{"completion", "bash"}}},
        {"manual", results::manual, true, {{"manual"}}}};
    return all;
}

bool is_number_or_null(const json& value) {
    return value.is_number() || value.is_null();
}

bool is_of_kind(const json& given, Field::Kind kind) {
    using enum Field::Kind;
    switch (kind) {
        case text:
        case word:
            return given.is_string();
        case words:
            return given.is_array() && std::ranges::all_of(given, &json::is_string);
        case whole:  // beyond 2^53 as text
            return given.is_number_integer() ||
                   (given.is_string() && given.get<std::string>().find_first_not_of("0123456789") == std::string::npos);
        case number:
            return given.is_number();
        case flag:
            return given.is_boolean();
        case vector:
            return given.is_array() && std::ranges::all_of(given, is_number_or_null);
        case object:
            return given.is_object();
        case array:
            return given.is_array();
        default:
            return kind == value;
    }
}

const Field* field_of(Fields fields, const std::string& name) {
    for (const auto& wanted : {std::string_view(name), std::string_view("NAME")})
        if (const auto found = std::ranges::find(fields, wanted, &Field::name); found != fields.end()) return &*found;
    return nullptr;
}

/// Every key has a field of its kind, and every field its key unless it is optional.
void expect_fields(const json& object, Fields fields, const std::string& place) {
    ASSERT_TRUE(object.is_object()) << place;
    for (const auto& field : fields)
        EXPECT_TRUE(field.optional || field.name == "NAME" || object.contains(field.name))
            << place << " has no key " << field.name;
    for (const auto& [name, value] : object.items()) {
        const std::string path = place + "." + name;
        const Field* field = field_of(fields, name);
        ASSERT_NE(field, nullptr) << path << " has no field";
        if (value.is_null()) continue;
        EXPECT_TRUE(is_of_kind(value, field->kind)) << path << " is " << value.dump();
        if (field->members.empty()) continue;
        if (value.is_object()) expect_fields(value, field->members, path);
        if (value.is_array())
            for (const auto& one : value) expect_fields(one, field->members, path + "[]");
    }
}

/// Adds a row per field. `seen`: path of the first object with the same fields.
void add_rows(std::string& table, Fields fields, const std::string& prefix, std::map<const Field*, std::string>& seen) {
    for (const auto& field : fields) {
        const auto path = prefix + std::string(field.name);
        std::string kind(campaign::kind_word(field.kind)), meaning(field.meaning);
        if (!field.unit.empty() && field.unit != "1") kind += ", " + std::string(field.unit);
        if (field.optional) kind += ", or absent";
        const auto [first, fresh] = seen.try_emplace(field.members.data(), path);
        const bool again = field.members.size() > 2 && !fresh;
        if (again) meaning += "; keys as of `" + first->second + "`";
        table += row({code(path), kind, meaning});
        if (!again) add_rows(table, field.members, path + (field.kind == Field::Kind::array ? "[]." : "."), seen);
    }
}

TEST(Json, OutputsHaveTheirFields) {
    const auto& folder = sample_folder();
    for (const auto& output : outputs())
        for (auto arguments : output.samples) {
            for (auto& word : arguments)
                if (word == "CASE") word = first_case(arguments[1]);
            arguments.insert(arguments.end(), {"--format", "json"});
            const auto ended = run_program(arguments, folder.path());
            const auto value = json::parse(ended.out, nullptr, false);
            const std::string name(output.name);
            ASSERT_EQ(value.is_array(), output.list) << name << ": " << ended.out.substr(0, 200) << ended.err;
            for (const auto& one : output.list ? value : json::array({value})) expect_fields(one, output.fields, name);
        }
}

}  // namespace grainsweep::tests::json_tables_test

namespace grainsweep::tests {

std::string json_table(const std::string& name) {
    using namespace json_tables_test;
    const auto found = std::ranges::find(outputs(), std::string_view(name), &Output::name);
    if (found == outputs().end()) throw std::invalid_argument("no table of JSON is called '" + name + "'");
    std::string table = head({"key", "value", "meaning"});
    std::map<const Field*, std::string> seen;
    add_rows(table, found->fields, found->list ? "[]." : "", seen);
    return table;
}

}  // namespace grainsweep::tests
