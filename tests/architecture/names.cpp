// Any files of one folder can be compiled together, as `./bootstrap.sh` does: what one of them keeps to itself has a
// name of its own. The compiler reports most clashes, but not those of overloads that only differ in a conversion.
#include "tests/support/places.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <string>
#include <utility>
#include <vector>

namespace grainsweep::tests::names_test {

namespace fs = std::filesystem;

std::vector<std::string> lines_of(const fs::path& file) {
    std::ifstream stream(file);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

std::vector<fs::path> sources_in(const std::string& folder) {
    std::vector<fs::path> found;
    for (const auto& entry : fs::recursive_directory_iterator(source(folder)))
        if (entry.path().extension() == ".cpp") found.push_back(entry.path());
    return found;
}

/// The type, function or constant that a line at the left edge of an anonymous namespace begins to define; empty: none.
std::string defined_in(const std::string& line) {
    static const std::regex type(R"(^(?:class|struct|enum(?: class)?|concept) (\w+))"),
        other(
            R"(^(?!using|template|static_assert|namespace|return)(?:\[\[\w+\]\] )?\w[\w:<>,&*\s]*?[\s&*](\w+)(?:\(|\[| =|\{|;))");
    std::smatch found;
    return std::regex_search(line, found, type) || std::regex_search(line, found, other) ? found.str(1) : "";
}

TEST(Names, OfAnonymousNamespacesOccurOnce) {
    EXPECT_EQ(defined_in("std::vector<std::pair<int, int>> pairs_of(const Cases& cases) {"), "pairs_of");
    EXPECT_EQ(defined_in("constexpr double largest = 3;  // m"), "largest");
    EXPECT_EQ(defined_in("[[noreturn]] void refuse(const std::string& what) {"), "refuse");
    EXPECT_EQ(defined_in("class Course {"), "Course");
    EXPECT_EQ(defined_in("using Json = nlohmann::json;"), "");
    using Place = std::map<std::pair<std::string, std::string>, fs::path>;  // of namespace and name
    Place hidden, seen;
    for (const char* folder : {"stats", "solver", "sweep"}) {
        for (const auto& file : sources_in(folder)) {
            std::string space;
            bool anonymous = false;
            for (const auto& line : lines_of(file)) {
                if (line.starts_with("namespace grainsweep")) space = line;
                if (line == "namespace {") anonymous = true;
                if (line == "}  // namespace") anonymous = false;
                const std::string name = defined_in(line);
                if (name.empty()) continue;
                const auto [place, added] = (anonymous ? hidden : seen).try_emplace({space, name}, file);
                EXPECT_TRUE(!anonymous || added || place->second == file)
                    << name << " in " << place->second << " and in " << file;
            }
        }
    }
    for (const auto& [name, file] : hidden) {  // inside an anonymous namespace it would hide the other
        const auto other = seen.find(name);
        EXPECT_TRUE(other == seen.end() || other->second == file) << name.second << " in " << file;
    }
    EXPECT_GT(hidden.size(), 500U);
}

TEST(Names, OfTestsAreInANamespaceOfTheirFile) {
    for (const char* kind : {"unit", "physics", "stability", "campaign", "documents", "architecture"}) {
        for (const auto& file : sources_in(std::string("tests/") + kind)) {
            const std::string space = "namespace grainsweep::tests::" + file.stem().string() + "_test {";
            bool found = false;
            for (const auto& line : lines_of(file)) {
                found = found || line == space;
                EXPECT_TRUE(found || !line.starts_with("TEST")) << file << " has no " << space;
            }
        }
    }
}

}  // namespace grainsweep::tests::names_test
