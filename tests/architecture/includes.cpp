// The include rules: every #include of every file is read, and a forbidden one fails.
#include "stats/convergence_rule.hpp"
#include "sweep/designs/design.hpp"
#include "tests/support/places.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

namespace grainsweep::tests::includes_test {

namespace fs = std::filesystem;

struct Include {
    std::string file;    // relative to the repository
    std::string target;  // as written
    bool ours = false;   // in quotes
};

bool starts_with_any(const std::string& text, const std::vector<std::string>& prefixes) {
    return std::ranges::any_of(prefixes, [&](const auto& prefix) { return text.starts_with(prefix); });
}

std::vector<fs::path> sources(const std::vector<std::string>& folders) {
    std::vector<fs::path> found;
    for (const auto& folder : folders) {
        const fs::path root = tests::source(folder);
        if (!fs::exists(root)) continue;
        for (const auto& entry : fs::recursive_directory_iterator(root)) {
            const auto extension = entry.path().extension();
            if (entry.is_regular_file() && (extension == ".cpp" || extension == ".hpp" || extension == ".inl")) {
                found.push_back(entry.path());
            }
        }
    }
    return found;
}

std::vector<Include> all_includes() {
    static const std::regex pattern(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"])");
    std::vector<Include> includes;
    for (const auto& path : sources({"stats", "solver", "sweep"})) {
        std::ifstream stream(path);
        std::string line;
        while (std::getline(stream, line)) {
            std::smatch match;
            if (std::regex_search(line, match, pattern)) {
                includes.push_back({fs::relative(path, tests::source()).string(), match[2], match[1] == "\""});
            }
        }
    }
    return includes;
}

/// Folder -> the prefixes of ours it may include.
struct Rule {
    std::string folder;
    std::vector<std::string> may;
};

const std::vector<Rule>& rules() {
    static const std::vector<Rule> table = {
        {"stats/", {"stats/"}},
        {"solver/bytes.hpp", {}},
        {"solver/field.hpp", {}},
        {"solver/plain_text.hpp", {}},
        {"solver/own_cores.hpp", {}},
        {"solver/threads/", {"solver/threads/", "solver/own_cores.hpp"}},
        {"solver/particles/",
         {"solver/particles/", "solver/bytes.hpp", "solver/plain_text.hpp", "solver/geometry/", "stats/"}},
        {"solver/geometry/", {"solver/geometry/", "solver/field.hpp", "stats/"}},
        {"solver/dem/",
         {"solver/dem/", "solver/bytes.hpp", "solver/field.hpp", "solver/own_cores.hpp", "solver/threads/",
          "solver/particles/", "solver/geometry/", "stats/"}},
        {"solver/flow/", {"solver/flow/", "solver/bytes.hpp", "solver/threads/", "solver/geometry/", "stats/"}},
        {"solver/coupling/",
         {"solver/coupling/", "solver/bytes.hpp", "solver/threads/", "solver/flow/", "solver/dem/", "solver/particles/",
          "solver/geometry/", "stats/"}},
        {"solver/observables/",
         {"solver/observables/", "solver/dem/engine.hpp", "solver/flow/", "solver/particles/", "solver/geometry/",
          "stats/"}},
        {"solver/machine/",
         {"solver/machine/", "solver/bytes.hpp", "solver/field.hpp", "solver/dem/", "solver/observables/",
          "solver/particles/", "solver/geometry/", "solver/scenes/scene.hpp", "solver/scenes/values.hpp",
          "solver/scenes/dem_picture.hpp", "solver/scenes/kit/", "stats/"}},
        {"solver/scenes/", {"solver/", "stats/"}},
        {"sweep/files/", {"sweep/files/", "solver/scenes/scene.hpp"}},
        {"sweep/campaign/machine",  // a machine file becomes numbers for the solver
         {"sweep/campaign/", "sweep/files/", "solver/machine/", "solver/field.hpp", "solver/plain_text.hpp",
          "solver/scenes/values.hpp", "solver/scenes/scene.hpp"}},
        {"sweep/campaign/powder",  // a powder file becomes parameters of scenes
         {"sweep/campaign/", "sweep/files/", "solver/plain_text.hpp", "solver/particles/size_",
          "solver/dem/material.hpp", "solver/dem/time_step.hpp", "solver/scenes/kit/", "solver/scenes/values.hpp"}},
        {"sweep/campaign/",
         {"sweep/campaign/", "sweep/designs/", "sweep/files/", "stats/convergence_rule.hpp", "stats/distribution.hpp",
          "stats/levels.hpp", "solver/field.hpp", "solver/plain_text.hpp", "solver/scenes/values.hpp",
          "solver/scenes/scene.hpp"}},
        {"sweep/designs/",
         {"sweep/designs/", "solver/field.hpp", "solver/plain_text.hpp", "solver/scenes/values.hpp", "stats/"}},
        {"sweep/schedule/",
         {"sweep/schedule/", "sweep/campaign/", "sweep/files/", "sweep/store/", "sweep/workers/worker_pool.hpp",
          "stats/", "solver/scenes/values.hpp"}},
        {"sweep/workers/",
         {"sweep/workers/", "sweep/campaign/", "sweep/files/", "solver/plain_text.hpp", "solver/own_cores.hpp",
          "solver/scenes/values.hpp", "solver/scenes/scene.hpp"}},
        {"sweep/store/",
         {"sweep/store/", "sweep/campaign/", "sweep/files/", "solver/scenes/values.hpp", "solver/scenes/scene.hpp",
          "stats/"}},
        {"sweep/spool/",
         {"sweep/spool/", "sweep/schedule/scheduler.hpp", "sweep/campaign/", "sweep/files/",
          "sweep/workers/worker_pool.hpp", "sweep/workers/message.hpp", "solver/scenes/scene.hpp"}},
        {"sweep/study/",
         {"sweep/study/", "sweep/store/", "sweep/campaign/", "sweep/files/", "sweep/schedule/",
          "sweep/designs/design.hpp", "sweep/designs/refine.hpp", "sweep/designs/calibration", "stats/",
          "solver/plain_text.hpp", "solver/scenes/values.hpp", "solver/scenes/scene.hpp"}},
        {"sweep/plot/", {"sweep/plot/", "sweep/files/"}},
        {"sweep/report/",
         {"sweep/report/", "sweep/plot/", "sweep/study/", "sweep/store/", "sweep/campaign/", "sweep/files/", "stats/",
          "solver/field.hpp", "solver/plain_text.hpp", "solver/scenes/values.hpp", "solver/scenes/scene.hpp"}},
        {"sweep/live/",
         {"sweep/live/", "sweep/report/", "sweep/store/", "sweep/campaign/", "sweep/files/",
          "sweep/workers/process_start.hpp", "solver/plain_text.hpp"}},
        {"sweep/media/",
         {"sweep/media/", "sweep/files/", "sweep/plot/plot.hpp", "sweep/report/sheet_file.hpp",
          "sweep/live/http_server.hpp"}},
        {"sweep/cli/run_campaign",  // a run computes and shows nothing
         {"sweep/cli/", "sweep/campaign/", "sweep/files/", "sweep/schedule/", "sweep/spool/", "sweep/store/",
          "sweep/study/", "sweep/workers/"}},
        {"sweep/cli/", {"sweep/", "stats/", "solver/scenes/values.hpp", "solver/scenes/scene.hpp"}},
    };
    return table;
}

/// Library header prefix -> the only places that may include it.
struct Library {
    std::string header;
    std::vector<std::string> only;
};

const std::vector<Library>& libraries() {
    static const std::vector<Library> table = {
        {"sqlite3.h", {"sweep/store/database", "sweep/store/expression"}},
        // Each costs seconds wherever it is included.
        {"boost/process", {"sweep/workers/process_start.cpp"}},
        {"boost/asio", {"sweep/workers/child.cpp"}},
        {"nlohmann/", {"sweep/campaign/", "sweep/workers/message.cpp", "sweep/workers/program_results.cpp"}},
        {"CLI/", {"sweep/cli/parser.cpp"}},
        {"Eigen/", {"solver/", "stats/"}},
        {"muParser.h", {"sweep/campaign/formula.cpp"}},
        {"udunits2.h", {"sweep/campaign/quantity.cpp"}},
        {"xlsxwriter.h", {"sweep/report/sheet_file.cpp"}},
        {"cairo", {"sweep/plot/"}},
        {"dlfcn.h", {"sweep/media/loaded.cpp"}},
        {"nlopt", {"stats/response/climb.cpp"}},
        {"hwy/", {"solver/dem/fast/lanes.hpp"}},
        {"immintrin.h", {}},  // vector instructions by Highway and by vector types of the compiler
        {"microhttpd.h", {"sweep/live/http_server.cpp"}},
        {"boost/crc.hpp", {"sweep/workers/host_frame.cpp"}},
        {"boost/",
         {"sweep/workers/child.cpp", "sweep/workers/process_start.cpp", "sweep/workers/host_frame.cpp",
          "sweep/designs/", "solver/", "stats/"}},
        {"fmt/", {"sweep/"}},
        {"chrono", {"sweep/", "solver/threads/thread_pool.cpp"}},  // times decide who computes, never what
        {"fstream", {"sweep/"}},
        {"filesystem", {"sweep/"}},
    };
    return table;
}

TEST(Architecture, EveryFolderIncludesOnlyWhatItMay) {
    const auto includes = all_includes();
    ASSERT_GT(includes.size(), 100U);
    for (const auto& include : includes) {
        if (!include.ours) continue;
        const auto rule = std::ranges::find_if(
            rules(), [&](const Rule& candidate) { return include.file.starts_with(candidate.folder); });
        ASSERT_NE(rule, rules().end()) << include.file << " is in no folder of the rules";
        EXPECT_TRUE(starts_with_any(include.target, rule->may)) << include.file << " includes " << include.target;
    }
}

/// The scene a file of solver/scenes belongs to: its folder's name, or its own.
std::string scene_of(const std::string& file) {
    const fs::path inside = fs::path(file).lexically_relative("solver/scenes");
    return inside.has_parent_path() ? inside.begin()->string() : inside.stem().string();
}

TEST(Architecture, ScenesDoNotIncludeScenes) {
    for (const auto& include : all_includes()) {
        if (!include.ours || !include.file.starts_with("solver/scenes/") ||
            !include.target.starts_with("solver/scenes/")) {
            continue;
        }
        const std::string target = scene_of(include.target);
        const std::string file = scene_of(include.file);
        const bool shared = target == "values" || target == "scene" || target == "catalogue" ||
                            target == "dem_picture" || target == "kit";
        EXPECT_TRUE(shared || file.find(target) != std::string::npos || target.find(file) != std::string::npos)
            << include.file << " includes " << include.target;
    }
}

TEST(Architecture, LibrariesStayWhereTheyBelong) {
    for (const auto& include : all_includes()) {
        if (include.ours) continue;
        for (const auto& library : libraries()) {
            if (!include.target.starts_with(library.header)) continue;
            // The rehearsal waits on purpose; it is no physics.
            if (library.header == "chrono" && include.file == "solver/scenes/rehearsal.cpp") break;
            EXPECT_TRUE(starts_with_any(include.file, library.only))
                << include.file << " includes <" << include.target << ">";
            break;
        }
    }
}

std::string text_of(const fs::path& path) {
    std::ifstream stream(path);
    return {std::istreambuf_iterator<char>(stream), {}};
}

// A campaign is read once, in sweep/campaign: what stands in an archive is read back there, too.
TEST(Architecture, StudyAndReportParseNoJsonAndTheStoreAsksForNone) {
    static const std::regex parses(
        R"(\bparse_json\b|\bJson::parse\b|\bjson::(?:parse|accept|sax_parse)\b|json_text\.hpp)");
    static const std::regex asks(R"(\bjsonb?_\w+\s*\(|"\s*->>?\s*'\$)");
    EXPECT_TRUE(std::regex_search(std::string("SELECT json_extract(a, '$.b')"), asks));
    for (const auto& path : sources({"sweep/study", "sweep/report"}))
        EXPECT_FALSE(std::regex_search(text_of(path), parses)) << path << " parses JSON";
    for (const auto& path : sources({"sweep/store"}))
        EXPECT_FALSE(std::regex_search(text_of(path), asks)) << path << " looks into JSON";
}

// A law is a file in solver/dem/laws and a place in its list: the engines follow from the list.
TEST(Architecture, EnginesNameNoContactLaw) {
    static const std::regex law(R"(\ntemplate <class Real(?:, bool \w+)?>\s+(?:struct|using) (\w+))");
    std::vector<std::string> names;
    for (const auto& path : sources({"solver/dem/laws"})) {
        const std::string file = path.filename().string(), text = text_of(path);
        if (file == "arithmetic.hpp" || file == "touch.hpp" || file == "contact.hpp") continue;  // their means
        for (std::sregex_iterator match(text.begin(), text.end(), law), end; match != end; ++match)
            names.push_back((*match)[1]);
    }
    EXPECT_GE(names.size(), 5U);
    for (const auto& path : sources({"solver/dem/clear", "solver/dem/fast"})) {
        const std::string text = text_of(path);
        for (const auto& name : names)
            EXPECT_FALSE(std::regex_search(text, std::regex("\\b" + name + "\\b"))) << path << " names " << name;
    }
}

// Walls are visited by their list: an engine that names a shape or a motion would have to learn each new one.
TEST(Architecture, NoEngineNamesAShapeOrAMotion) {
    static const std::regex list(R"(using (?:Shape|Motion) = std::variant<([^>]+)>;)"), word(R"(\w+)");
    std::vector<std::string> names;
    for (const char* file : {"solver/geometry/shapes.hpp", "solver/geometry/motion.hpp"}) {
        const std::string text = text_of(tests::source(file));
        std::smatch match;
        ASSERT_TRUE(std::regex_search(text, match, list)) << file;
        const std::string alternatives = match[1];
        for (std::sregex_iterator name(alternatives.begin(), alternatives.end(), word), end; name != end; ++name)
            names.push_back(name->str());
    }
    EXPECT_GE(names.size(), 7U);
    for (const auto& path : sources({"solver/dem/clear", "solver/dem/fast"})) {
        const std::string text = text_of(path);
        for (const auto& name : names)
            EXPECT_FALSE(std::regex_search(text, std::regex("\\b" + name + "\\b"))) << path << " names " << name;
    }
}

// Rules and designs have rows of traits: what compared their names would have to learn each new one.
TEST(Architecture, NothingComparesTheNameOfARuleOrADesign) {
    std::string words;
    for (const auto& rule : stats::convergence_rules) words.append(words.empty() ? "" : "|").append(rule.name);
    for (const auto& design : designs::design_catalogue()) words += "|" + design.name;
    words += "|calibration";
    const std::regex compares("(rule|design|kind|name) [!=]= \"(" + words + ")\"|\"(" + words +
                              ")\" [!=]= [\\w.>-]*(rule|design|kind)");
    EXPECT_TRUE(std::regex_search(std::string("if (record.design != \"refine\")"), compares));
    EXPECT_TRUE(std::regex_search(std::string("wanted->rule == \"assisted\""), compares));
    for (const auto& path : sources({"sweep", "stats"})) {
        if (path.string().find("/sweep/designs/") != std::string::npos) continue;  // the catalogue, and options of them
        std::ifstream stream(path);
        for (std::string line; std::getline(stream, line);) {
            const bool may = line.find("= \"") != std::string::npos || line.find("\" =") != std::string::npos;
            EXPECT_FALSE(may && std::regex_search(line, compares)) << path << ": " << line;
        }
    }
}

TEST(Architecture, NoFileIsNamedForNothingOrEndless) {
    for (const auto& path : sources({"stats", "solver", "sweep", "tests"})) {
        const std::string stem = path.stem().string();
        for (const char* drawer : {"util", "utils", "common", "helper", "helpers", "manager", "core", "misc"}) {
            EXPECT_NE(stem, drawer) << path;
        }
        std::ifstream stream(path);
        const auto lines = std::count(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>(), '\n');
        EXPECT_LE(lines, 700) << path << " has " << lines << " lines";
    }
}

}  // namespace grainsweep::tests::includes_test
