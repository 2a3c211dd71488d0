// Who opens files: SQLite alone opens databases (sweep/files/locked_files.hpp). Each file of the office that opens
// others itself is listed here with what they are, and none of them can be a database.
#include "tests/support/places.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

namespace grainsweep::tests::opened_files_test {

namespace fs = std::filesystem;

const std::map<std::string, std::string>& openers() {
    static const std::map<std::string, std::string> known = {
        {"sweep/cli/build_facts.cpp", "/proc/cpuinfo"},
        {"sweep/cli/commands_run.cpp", "/dev/null"},
        {"sweep/cli/main.cpp", "/dev/null"},
        {"sweep/cli/page_file.cpp", "pages that are written; refuses databases first"},
        {"sweep/files/artefacts.cpp", "artefacts, by the hash in their names"},
        {"sweep/files/aside_file.cpp", "new files"},
        {"sweep/files/descriptor.cpp", "folders"},
        {"sweep/files/whole_file.cpp", "any file but a database of this process"},
        {"sweep/cli/written_campaign.cpp", "new campaign files"},
        {"sweep/live/jobs.cpp", "a new log"},
        {"sweep/spool/spool.cpp", "files of a spool"},
        {"sweep/workers/memory_room.cpp", "/proc and /sys"},
        {"sweep/workers/process_start.cpp", "/dev/null"},
        {"sweep/workers/program_folder.cpp", "of a worker, which opens no database"},
        {"sweep/workers/program_guard.cpp", "of a worker"},
        {"sweep/workers/program_answerer.cpp", "of a worker"},
        {"sweep/workers/program_process.cpp", "of a worker"},
        {"sweep/workers/program_setting.cpp", "of a worker"},
    };
    return known;
}

constexpr std::array words_that_open = {"std::ifstream ", "std::ofstream ", "std::fstream ", "fopen(",
                                        "O_RDONLY",       "O_RDWR",         "O_WRONLY"};

TEST(OpenedFiles, NobodyButSqliteOpensADatabase) {
    const auto opens = [](const std::string& line) {
        return std::ranges::any_of(words_that_open,
                                   [&](const char* word) { return line.find(word) != std::string::npos; });
    };
    std::map<std::string, int> found;
    for (const auto& entry : fs::recursive_directory_iterator(source("sweep"))) {
        if (entry.path().extension() != ".cpp" && entry.path().extension() != ".hpp") continue;
        const auto name = fs::relative(entry.path(), source()).string();
        std::ifstream stream(entry.path());
        for (std::string line; std::getline(stream, line);) {
            if (opens(line)) ++found[name];
        }
    }
    for (const auto& [name, count] : found) {
        EXPECT_TRUE(openers().contains(name))
            << name << " opens files: read them by whole_file(), or see sweep/files/locked_files.hpp";
    }
    for (const auto& [name, what] : openers()) EXPECT_TRUE(found.contains(name)) << name << " (" << what << ")";
}

}  // namespace grainsweep::tests::opened_files_test
