// The clock of the day is set while a campaign runs: by a time server, on a laptop that wakes.
#include "tests/support/places.hpp"
#include "tests/support/process.hpp"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace grainsweep::tests::clock_test {

TEST(AClockThatIsSet, LeavesRateAndTimeLeftAsTheyPass) {
    for (const char* seconds : {"3600", "-86400"}) {
        const Folder folder;
        folder.write("c.json",
                     R"({"campaign": "c", "scene": "rehearsal", "factors": [{"name": "x1", "between": [0, 1]}],
            "fixed": {"wait_seconds": 0.2}, "design": {"kind": "halton", "points": 8}})");
        std::vector<std::string> argv = {"/usr/bin/env", "LD_PRELOAD=" + grainsweep::tests::failing_calls().string(),
                                         std::string("GRAINSWEEP_CLOCK_SET_BACK=") + seconds};
        const auto command = program_command({"run", "c.json", "-j", "1", "--max-cases", "6", "--quiet"});
        argv.insert(argv.end(), command.begin(), command.end());
        EXPECT_EQ(Process(argv, folder.path()).wait().code, 1) << "two are left";
        const auto status = run_program({"status", "c.db", "--format", "json"}, folder.path());
        const auto row = nlohmann::json::parse(status.out)[0];
        EXPECT_GT(row["rate"].get<double>(), 0.3) << seconds;
        EXPECT_LT(row["rate"].get<double>(), 5) << seconds;
        EXPECT_GT(row["time_left"].get<double>(), 0.3) << seconds;
        EXPECT_LT(row["time_left"].get<double>(), 7) << seconds;
    }
}

}  // namespace grainsweep::tests::clock_test
