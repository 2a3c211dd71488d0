// Tests and programs that the documents name as proof exist.
#include "tests/documents/page.hpp"
#include "tests/support/places.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <regex>
#include <set>

namespace grainsweep::tests::proofs_test {

namespace fs = std::filesystem;

/// Suites of tests by the kind of test they stand in ("unit", "physics", "bench").
std::set<std::pair<std::string, std::string>> suites() {
    static const std::regex test(R"(\bTEST(?:_F|_P)?\((\w+), (\w+)\))");
    std::set<std::pair<std::string, std::string>> found;
    for (const auto& entry : fs::recursive_directory_iterator(source("tests"))) {
        if (entry.path().extension() != ".cpp") continue;
        std::ifstream stream(entry.path());
        const std::string text{std::istreambuf_iterator<char>(stream), {}};
        for (std::sregex_iterator it(text.begin(), text.end(), test), end; it != end; ++it)
            found.emplace(entry.path().parent_path().filename().string(), (*it)[1]);
    }
    return found;
}

bool is_program(const std::string& name) {
    const fs::path bench = source("tests") / "bench";
    const std::string part = name.substr(name.find('_') + 1);
    if (name.starts_with("test_")) return fs::is_directory(source("tests") / part);
    if (name.starts_with("slow_")) return fs::exists(bench / (part + "_slow.cpp"));
    return fs::exists(bench / (part + "_speed.cpp")) || fs::exists(bench / (part + ".cpp"));
}

TEST(Proofs, EveryProgramOfTheTestsThatIsNamedExists) {
    static const std::regex program(R"(\b(?:test|slow|bench)_[a-z_]*[a-z]\b)");
    std::size_t named = 0;
    for (const auto& page : all_pages()) {
        if (page.file.string().starts_with("tests/")) continue;
        for (std::sregex_iterator it(page.text.begin(), page.text.end(), program), end; it != end; ++it, ++named)
            EXPECT_TRUE(is_program(it->str())) << page.file << " names " << it->str();
    }
    EXPECT_GT(named, 30U);
}

TEST(Proofs, EverySuiteThatIsNamedExists) {
    static const std::regex pattern(R"(\b([A-Z][A-Za-z]+)\.(?:\*|[A-Z]\w*\*?))");
    std::set<std::string> known;
    for (const auto& [kind, suite] : suites()) known.insert(suite);
    std::size_t named = 0;
    for (const auto& page : all_pages()) {
        if (page.file.string().starts_with("tests/")) continue;
        for (const auto& span : page.code_spans())
            for (std::sregex_iterator it(span.begin(), span.end(), pattern), end; it != end; ++it, ++named)
                EXPECT_TRUE(known.contains((*it)[1])) << page.file << " names " << it->str();
    }
    EXPECT_GT(named, 20U);
}

/// The last column of docs/verification.md: "`test_physics`, DemSettling, ChungOoi; `slow_flow`" and the like.
TEST(Proofs, EveryLineOfTheTrustTableNamesATestOrProgram) {
    static const std::regex row(R"(^\| (.*) \| (.*) \| ([^|]*) \|$)");
    static const std::regex named("`(test|slow|bench)_([a-z_]+)[^`]*`((?:, [A-Z][A-Za-z]+)*)");
    static const std::regex suite("[A-Z][A-Za-z]+");
    const auto known = suites();
    std::size_t rows = 0;
    for (const auto& [number, line] : read_page("docs/verification.md").prose()) {
        std::smatch cells;
        if (!std::regex_match(line, cells, row) || cells[3] == "how") continue;
        ++rows;
        const std::string how = cells[3];
        EXPECT_TRUE(std::regex_search(how, named)) << "line " << number << " has no proof: " << how;
        for (std::sregex_iterator it(how.begin(), how.end(), named), end; it != end; ++it) {
            if ((*it)[1] != "test") continue;
            const std::string names = (*it)[3];
            for (std::sregex_iterator name(names.begin(), names.end(), suite); name != end; ++name)
                EXPECT_TRUE(known.contains({(*it)[2], name->str()})) << "line " << number << ": no " << name->str();
        }
    }
    EXPECT_GE(rows, 15U);
}

}  // namespace grainsweep::tests::proofs_test
