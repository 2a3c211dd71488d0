// Main program and workers are killed at named points: between writing and syncing, syncing and renaming, handing out
// and answering. The next run ends with the undisturbed dump, every attempt is counted as it was, nothing is left
// behind. slow_faults kills at every such call there is, not only at one of each.
#include "tests/support/failing_call.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <string>
#include <vector>

namespace grainsweep::tests::named_points_test {

constexpr int killed = 128 + 9;

void expect_survived(const SmallCampaign& campaign, const std::vector<FailingCall>& points, int code) {
    for (const auto& point : points) {
        const auto trial = campaign.attempt(point);
        EXPECT_TRUE(trial.happened) << point.name();
        EXPECT_EQ(trial.disturbed.code, code) << point.name() << ": " << trial.disturbed.err;
        EXPECT_EQ(trial.complaint, "") << point.name();
    }
}

// The second commit of a run enrols its cases.
TEST(NamedPoints, TheMainProgramIsKilledAroundItsCommits) {
    expect_survived(SmallCampaign(),
                    {{"main", "open", "d.db-wal", "after"},
                     {"main", "sync", "d.db-wal", "before", 2},
                     {"main", "sync", "d.db-wal", "after", 2},
                     {"main", "write", "d.db-wal", "before", 40},
                     {"main", "sync", "d.db", "before"},
                     {"main", "remove", "d.db-wal"}},
                    killed);
}

TEST(NamedPoints, TheMainProgramIsKilledBetweenCaseAndAnswer) {
    expect_survived(SmallCampaign(),
                    {{"main", "write", "pipe", "before"},
                     {"main", "write", "pipe", "after", 2},
                     {"main", "read", "pipe", "after", 3},
                     {"main", "read", "pipe", "after", 6},
                     {"main", "remove", ".artefact"},
                     {"main", "remove", ".artefact", "after"}},
                    killed);
}

TEST(NamedPoints, AWorkerIsKilledBetweenCaseAndAnswer) {
    expect_survived(SmallCampaign(),
                    {{"worker", "write", "pipe", "before"},
                     {"worker", "write", "pipe", "after"},
                     {"worker", "read", "pipe", "after"},
                     {"worker", "write", "pipe", "before", 3},
                     {"worker", "write", "pipe", "after", 3}},
                    0);
}

TEST(NamedPoints, AWorkerIsKilledAroundItsCheckpoint) {
    expect_survived(SmallCampaign(),
                    {{"worker", "open", ".aside", "after"},
                     {"worker", "write", ".aside", "after", 2},
                     {"worker", "sync", ".aside", "before"},
                     {"worker", "rename", ".aside", "before", 2},
                     {"worker", "rename", ".aside", "after", 3},
                     {"worker", "sync", ".artefacts", "after", 4}},
                    0);
}

// What saves checkpoints and shared states fails: the run ends, names the folder, and no case has failed.
TEST(NamedPoints, ACheckpointThatCannotBeWrittenEndsTheRun) {
    const SmallCampaign campaign;
    for (const char* call : {"open", "write", "sync", "rename"}) {
        const FailingCall failing{"worker", call, ".aside", "before", 2, std::to_string(-ENOSPC)};
        const auto trial = campaign.attempt(failing);
        EXPECT_TRUE(trial.happened) << call;
        EXPECT_EQ(trial.disturbed.code, 3) << call;
        EXPECT_NE(trial.disturbed.err.find("d.artefacts"), std::string::npos) << trial.disturbed.err;
        EXPECT_NE(trial.disturbed.err.find("No space left"), std::string::npos) << trial.disturbed.err;
        EXPECT_EQ(trial.complaint, "") << call;
    }
}

}  // namespace grainsweep::tests::named_points_test
