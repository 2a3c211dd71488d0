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

/// Returns the words of the last column of the glossary's tables, which stand in backticks.
std::vector<std::string> retired_words() {
    static const std::regex row(R"(^\|[^|]*\|[^|]*\|([^|]*)\|$)"), word("`(\\w+)`");
    std::vector<std::string> words;
    for (const auto& line : lines_of(source("docs/glossary.md"))) {
        std::smatch cells;
        if (!std::regex_match(line, cells, row)) continue;
        const std::string last = cells.str(1);
        for (std::sregex_iterator it(last.begin(), last.end(), word), end; it != end; ++it) words.push_back((*it)[1]);
    }
    return words;
}

// docs/glossary.md says which word stands for what; another word for it would have to be learned.
TEST(Names, RetiredWordsOfTheGlossaryAreGone) {
    const auto words = retired_words();
    ASSERT_GE(words.size(), 7U);
    std::string either;
    for (const auto& word : words) either += (either.empty() ? "" : "|") + word;
    const std::regex retired("\\b(" + either + ")\\b");
    for (const char* folder : {"stats", "solver", "sweep"})
        for (const auto& entry : fs::recursive_directory_iterator(source(folder))) {
            if (entry.path().extension() != ".cpp" && entry.path().extension() != ".hpp") continue;
            for (const auto& line : lines_of(entry.path())) {
                const std::string code = line.substr(0, line.find("//"));
                EXPECT_FALSE(std::regex_search(code, retired)) << entry.path() << ": " << line;
            }
        }
}

}  // namespace grainsweep::tests::names_test
