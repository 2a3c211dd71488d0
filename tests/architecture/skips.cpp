// A clone alone proves everything: no test is left out for want of data or of another program.
#include "tests/support/places.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace grainsweep::tests::skips_test {

// The only reason to leave a test out is that root may write everywhere, so that what is tested
// cannot occur.
TEST(Tests, AreLeftOutForRootOnly) {
    const std::string macro = std::string("GTEST_") + "SKIP()";
    for (const auto& entry : std::filesystem::recursive_directory_iterator(tests::source("tests"))) {
        const auto extension = entry.path().extension();
        if (extension != ".cpp" && extension != ".hpp") continue;
        std::ifstream stream(entry.path());
        for (std::string line; std::getline(stream, line);) {
            if (line.find(macro) == std::string::npos) continue;
            EXPECT_NE(line.find("geteuid() == 0"), std::string::npos) << entry.path() << ": " << line;
        }
    }
}

}  // namespace grainsweep::tests::skips_test
