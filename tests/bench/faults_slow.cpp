// Every call of the real program to the system that changes a file or crosses a pipe: killed before and after each, and
// failed at each, one run at a time, minutes: slow_faults. tests/campaign/named_points.cpp takes one of each kind.
// Prints rows of the table in docs/reliability.md.
#include "tests/support/failing_call.hpp"
#include "tests/support/tried.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <cstring>
#include <string>
#include <vector>

using namespace grainsweep::tests;
using grainsweep::tests::tried;

namespace {

constexpr int killed = 128 + 9;

/// The call at its first, second, ... time, until a run meets it no more. How often it was met.
template <class Allowed>
int at_every_time(const SmallCampaign& campaign, FailingCall call, Allowed&& allowed) {
    int held = 0;
    for (call.number = 1;; ++call.number) {
        const auto trial = campaign.attempt(call);
        EXPECT_TRUE(allowed(trial)) << call.name() << " ended with " << trial.disturbed.code << ": "
                                    << trial.disturbed.err;
        EXPECT_EQ(trial.complaint, "") << call.name();
        if (!trial.happened) break;
        ++held;
    }
    const std::string what = call.what == "kill" ? "killed " + call.when + " it" : std::strerror(-std::stoi(call.what));
    tried(call.who + ": " + call.call + " of " + call.file + ", " + what, held);
    return held;
}

struct Place {
    const char* call;
    const char* file;
};

const std::vector<Place> of_the_main_program = {
    {"open", "d.db"}, {"open", "d.db-wal"}, {"open", "d.db-shm"},   {"write", "d.db"},      {"write", "d.db-wal"},
    {"sync", "d.db"}, {"sync", "d.db-wal"}, {"remove", "d.db-wal"}, {"remove", "d.db-shm"}, {"remove", ".artefact"}};
const std::vector<Place> of_a_worker = {
    {"open", ".aside"}, {"write", ".aside"}, {"sync", ".aside"}, {"rename", ".aside"}, {"sync", ".artefacts"}};
const std::vector<Place> pipes = {{"write", "pipe"}, {"read", "pipe"}};

std::vector<Place> with_pipes(std::vector<Place> places) {
    places.insert(places.end(), pipes.begin(), pipes.end());
    return places;
}

void kill_everywhere(const std::string& who, const std::vector<Place>& places, int code) {
    const SmallCampaign campaign;
    int met = 0;
    for (const auto& [call, file] : places)
        for (const char* when : {"before", "after"}) {
            if (std::string(call) == "read" && std::string(when) == "before")
                continue;  // no change since the last call
            met += at_every_time(campaign, {who, call, file, when}, [&](const auto& trial) {
                return trial.disturbed.code == (trial.happened ? code : 0);
            });
        }
    EXPECT_GT(met, 40);
}

TEST(EveryCall, TheMainProgramIsKilledAtIt) {
    kill_everywhere("main", with_pipes(of_the_main_program), killed);
}

TEST(EveryCall, AWorkerIsKilledAtIt) {
    kill_everywhere("worker", with_pipes(of_a_worker), 0);
}

// A fault while closing is not reported: everything is on disk by then. Nor is one of a file that is only tidied away.
TEST(EveryCall, OfTheMainProgramToItsDatabaseFails) {
    const SmallCampaign campaign;
    int reported = 0;
    for (const auto& [call, file] : of_the_main_program)
        for (const int number : {EIO, ENOSPC})
            at_every_time(campaign, {"main", call, file, "before", 1, std::to_string(-number)}, [&](const auto& trial) {
                reported += trial.disturbed.code == 3 ? 1 : 0;
                return trial.disturbed.code == 3 || trial.disturbed.code == 0;
            });
    EXPECT_GT(reported, 40);
}

TEST(EveryCall, OfAWorkerToItsFolderFails) {
    const SmallCampaign campaign;
    for (const auto& [call, file] : of_a_worker)
        for (const int number : {EIO, ENOSPC, EDQUOT})
            EXPECT_GT(at_every_time(campaign, {"worker", call, file, "before", 1, std::to_string(-number)},
                                    [](const auto& trial) { return trial.disturbed.code == (trial.happened ? 3 : 0); }),
                      5);
}

}  // namespace
