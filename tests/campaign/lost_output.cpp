// Progress and summary may find no reader and no disk: the campaign goes on and ends with its own exit code.
#include "tests/support/places.hpp"
#include "tests/support/process.hpp"

#include <gtest/gtest.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace grainsweep::tests::lost_output_test {

// Unstable cases make notes while the campaign runs; they also make its exit code 1, which nothing else here gives.
const char* config = R"({"campaign": "unheard", "scene": "rehearsal",
  "factors": [{"name": "x1", "between": [0, 1]}, {"name": "behaviour", "levels": ["normal", "unstable"]}],
  "fixed": {"wait_seconds": 0.02}, "design": {"kind": "halton", "scramble": "none", "points": 16}})";
constexpr int some_failed = 1;

/// Runs `script` in a shell where "$@" is the campaign's command; the exit code is the script's.
Ended in_shell(const Folder& folder, const std::string& script) {
    std::vector<std::string> argv = {"/bin/bash", "-c", script, "bash"};
    const auto command = program_command({"run", "c.json", "-j", "2"});
    argv.insert(argv.end(), command.begin(), command.end());
    return Process(argv, folder.path()).wait();
}

class LostOutput : public testing::Test {
protected:
    LostOutput() {
        folder.write("c.json", config);
        EXPECT_EQ(run_program({"run", "c.json", "--db", "calm.db", "--quiet"}, folder.path()).code, some_failed);
    }
    void expect_whole() const {
        const auto disturbed = run_program({"dump", "unheard.db"}, folder.path());
        EXPECT_EQ(disturbed.code, 0) << disturbed.err;
        EXPECT_TRUE(disturbed.out == run_program({"dump", "calm.db"}, folder.path()).out);
    }
    Folder folder;
};

TEST_F(LostOutput, AFullDiskUnderStandardErrorIsSurvived) {
    EXPECT_EQ(in_shell(folder, R"("$@" 2>/dev/full)").code, some_failed);
    expect_whole();
}

TEST_F(LostOutput, AReaderThatLeavesIsSurvived) {
    EXPECT_EQ(in_shell(folder, R"("$@" 2>&1 | true; exit ${PIPESTATUS[0]})").code, some_failed);
    expect_whole();
    EXPECT_EQ(in_shell(folder, R"("$@" --again unstable 2>&1 | head -1; exit ${PIPESTATUS[0]})").code, some_failed);
}

TEST_F(LostOutput, ClosedDescriptorsAreNotTheDatabases) {
    for (const char* script : {R"("$@" 0<&- 1>&- 2>&-)", R"("$@" 1>&-)", R"("$@" 2>&-)"}) {
        for (const char* file : {"unheard.db", "unheard.db-wal", "unheard.db-shm"})
            std::filesystem::remove(folder / file);
        EXPECT_EQ(in_shell(folder, script).code, some_failed) << script;
        expect_whole();
    }
}

// Everything but a campaign still says that its output did not arrive.
TEST_F(LostOutput, AnAnswerThatDoesNotArriveIsNoSuccess) {
    const auto ended = Process({"/bin/bash", "-c", R"("$@" 1>&-)", "bash", grainsweep::tests::executable().string(),
                                "dump", "calm.db"},
                               folder.path())
                           .wait();
    EXPECT_EQ(ended.code, 3);
    EXPECT_NE(ended.err.find("standard output cannot be written"), std::string::npos) << ended.err;
}

TEST_F(LostOutput, AClosedTerminalIsSurvived) {
    const std::string program = grainsweep::tests::executable().string();
    int terminal = -1;
    const pid_t runs = ::forkpty(&terminal, nullptr, nullptr, nullptr);
    ASSERT_GE(runs, 0);
    if (runs == 0) {
        if (::chdir(folder.path().c_str()) != 0) ::_exit(126);
        ::execl(program.c_str(), program.c_str(), "run", "c.json", "-j", "1", nullptr);
        ::_exit(127);
    }
    std::array<char, 256> seen{};
    EXPECT_GT(::read(terminal, seen.data(), seen.size()), 0) << "a bar, or a note";
    ::close(terminal);
    int status = 0;
    ASSERT_EQ(::waitpid(runs, &status, 0), runs);
    EXPECT_TRUE(WIFEXITED(status)) << "ended by signal " << WTERMSIG(status);
    EXPECT_EQ(WEXITSTATUS(status), some_failed);
    expect_whole();
}

}  // namespace grainsweep::tests::lost_output_test
