// A killed campaign goes on inside the case: the worker's checkpoint is continued bit for bit.
#include "tests/support/process.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

namespace grainsweep::tests::checkpoints_test {

// A second or two of real physics; the launcher shortens the interval between checkpoints.
const char* config = R"({
  "campaign": "long", "scene": "powder_spreading",
  "factors": [{"name": "gap", "levels": [0.005]}],
  "fixed": {"diameter": 0.003, "precision": "double"},
  "design": {"kind": "lattice"},
  "execution": {"launcher": ["/bin/sh", "-c", "exec \"$@\" --checkpoint-seconds 0.1", "sh"]}
})";

/// Whole files but the definition of the machine, which its workers read; what a killed process left half written
/// beside them is swept later.
std::size_t files_in(const std::filesystem::path& folder) {
    std::size_t count = 0;
    std::error_code absent;
    for (const auto& entry : std::filesystem::directory_iterator(folder, absent)) {
        if (entry.path().extension() != ".artefact") continue;
        std::ifstream file(entry.path(), std::ios::binary);
        std::string head(200, '\0');
        file.read(head.data(), static_cast<std::streamsize>(head.size()));
        count += head.find("definition") == std::string::npos;
    }
    return count;
}

void await_checkpoint(Process& run, const std::filesystem::path& folder) {
    while (run.running() && files_in(folder) == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

std::string dump(const Folder& folder, const std::string& db) {
    return run_program({"dump", db}, folder.path()).out;
}

TEST(Checkpoints, AKilledWorkersCaseIsContinued) {
    const Folder folder;
    folder.write("c.json", config);
    EXPECT_EQ(run_program({"run", "c.json", "--db", "calm.db", "--quiet"}, folder.path()).code, 0);
    EXPECT_EQ(files_in(folder / "calm.artefacts"), 0U) << "a checkpoint outlived its case";

    Process run(program_command({"run", "c.json", "--db", "hit.db", "--quiet"}), folder.path());
    await_checkpoint(run, folder / "hit.artefacts");
    ASSERT_TRUE(run.running()) << "the case was over before its first checkpoint";
    for (const pid_t worker : run.children()) ::kill(worker, SIGKILL);
    const auto ended = run.wait();
    EXPECT_EQ(ended.code, 0) << ended.err;
    EXPECT_TRUE(dump(folder, "hit.db") == dump(folder, "calm.db"));
    EXPECT_EQ(files_in(folder / "hit.artefacts"), 0U);
}

TEST(Checkpoints, ACaseOfAKilledMainProgramIsContinued) {
    const Folder folder;
    folder.write("c.json", config);
    run_program({"run", "c.json", "--db", "calm.db", "--quiet"}, folder.path());
    {
        Process run(program_command({"run", "c.json", "--db", "hit.db", "--quiet"}), folder.path());
        await_checkpoint(run, folder / "hit.artefacts");
        run.signal(SIGKILL);
        run.wait();
    }
    EXPECT_EQ(files_in(folder / "hit.artefacts"), 1U);
    EXPECT_EQ(run_program({"run", "c.json", "--db", "hit.db", "--quiet"}, folder.path()).code, 0);
    EXPECT_TRUE(dump(folder, "hit.db") == dump(folder, "calm.db"));
    EXPECT_EQ(files_in(folder / "hit.artefacts"), 0U);
}

TEST(Checkpoints, ThatOfAnUnfinishedCaseIsShown) {
    const Folder folder;
    folder.write("c.json", config);
    {
        Process run(program_command({"run", "c.json", "--db", "hit.db", "--quiet"}), folder.path());
        await_checkpoint(run, folder / "hit.artefacts");
        run.signal(SIGKILL);
        run.wait();
    }
    const auto ids = run_program({"query", "hit.db", "SELECT case_id FROM long", "--format", "csv"}, folder.path()).out;
    const auto id = ids.substr(ids.find('\n') + 1, 32);
    const auto shown = run_program({"replay", "hit.db", id, "--watch", "case.html"}, folder.path());
    EXPECT_EQ(shown.code, 0) << shown.err;
    EXPECT_NE(shown.out.find("1 frame of"), std::string::npos) << shown.out;
    EXPECT_EQ(run_program({"replay", "hit.db", id}, folder.path()).code, 2) << "nothing to compare with";
    std::filesystem::remove_all(folder / "hit.artefacts");
    const auto none = run_program({"replay", "hit.db", id, "--watch", "case.html"}, folder.path());
    EXPECT_EQ(none.code, 2);
    EXPECT_NE(none.err.find("no checkpoint"), std::string::npos) << none.err;
}

// A checkpoint says of which build and instruction path it is; once its case is settled it is of no use to any.
TEST(Checkpoints, ThoseOfAnotherInstructionPathAreSweptWithTheirCase) {
    const Folder folder;
    folder.write("c.json", R"({"campaign": "c", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
        "fixed": {"wait_seconds": 0.1}, "design": {"kind": "halton", "points": 2},
        "execution": {"workers": 2, "launcher": ["/bin/sh", "-c", "exec \"$@\" --checkpoint-seconds 0", "sh"]}})");
    {
        Process run(program_command({"run", "c.json", "--quiet", "--path", "avx2"}), folder.path());
        await_checkpoint(run, folder / "c.artefacts");
        run.signal(SIGKILL);
        run.wait();
    }
    EXPECT_GT(files_in(folder / "c.artefacts"), 0U);
    EXPECT_EQ(run_program({"run", "c.json", "--quiet"}, folder.path()).code, 0);
    EXPECT_EQ(files_in(folder / "c.artefacts"), 0U);
}

}  // namespace grainsweep::tests::checkpoints_test
