// The file beside a database that says what its run does: written and read again, and texts that are none.
#include "sweep/files/processes.hpp"
#include "sweep/live/now.hpp"
#include "tests/support/process.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>

namespace grainsweep::tests::live_now_test {

namespace fs = std::filesystem;
using namespace live;

Now some_run() {
    return {
        .campaign = "drum",
        .host = "node 7",
        .process = 4711,
        .questions = 100,
        .decided = 12,
        .failed = 2,
        .settled = 10,
        .seconds = 61.5,
        .seconds_left = 3600.25,
        .judgement = "mean +- 3 % at 8 points",
        .running = {{std::string(32, 'a'), 1, 0.25, 12.5, "node 8"}, {std::string(32, 'b'), 3, std::nullopt, 0.5, ""}}};
}

TEST(LiveNow, ComesBackAsItWasWritten) {
    const Folder folder;
    const auto database = folder / "x.db";
    EXPECT_EQ(now_file(database), folder / "x.now");
    EXPECT_FALSE(read_now(database));
    write_now(now_file(database), some_run());
    const auto read = read_now(database);
    ASSERT_TRUE(read);
    EXPECT_EQ(read->campaign, "drum");
    EXPECT_EQ(read->host, "node 7");
    EXPECT_EQ(read->process, 4711);
    EXPECT_EQ(read->questions, 100);
    EXPECT_EQ(read->decided, 12);
    EXPECT_EQ(read->failed, 2);
    EXPECT_EQ(read->settled, 10);
    EXPECT_EQ(read->seconds, 61.5);
    EXPECT_EQ(read->seconds_left, 3600.25);
    EXPECT_EQ(read->judgement, "mean +- 3 % at 8 points");
    ASSERT_EQ(read->running.size(), 2u);
    EXPECT_EQ(read->running[0].case_id, std::string(32, 'a'));
    EXPECT_EQ(read->running[0].attempt, 1);
    EXPECT_EQ(read->running[0].share, 0.25);
    EXPECT_EQ(read->running[0].seconds, 12.5);
    EXPECT_EQ(read->running[0].host, "node 8");
    EXPECT_FALSE(read->running[1].share) << "not known is not 0";
    EXPECT_EQ(read->running[1].host, "");
}

TEST(LiveNow, AFileThatWasNotWrittenLatelySaysNothing) {
    const Folder folder;
    const auto database = folder / "x.db";
    write_now(now_file(database), some_run());
    fs::last_write_time(now_file(database), fs::file_time_type::clock::now() - std::chrono::seconds(11));
    EXPECT_FALSE(read_now(database)) << "its run was killed";
}

TEST(LiveNow, AFileOfTheFutureALinkAndALargeOneSayNothing) {
    const Folder folder;
    const auto database = folder / "x.db", file = now_file(database);
    write_now(file, some_run());
    fs::last_write_time(file, fs::file_time_type::clock::now() + std::chrono::hours(1));
    EXPECT_FALSE(read_now(database)) << "it would say so for an hour";
    write_now(folder / "other.now", some_run());
    fs::remove(file);
    fs::create_symlink(folder / "other.now", file);
    EXPECT_FALSE(read_now(database));
    fs::remove(file);
    folder.write("x.now", text_of(some_run()) + std::string(2U << 20U, '\n'));
    EXPECT_FALSE(read_now(database));
    fs::remove(file);
    ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
    EXPECT_FALSE(read_now(database)) << "a named pipe is not opened";
}

TEST(LiveNow, ARunOfThisHostWhoseProcessHasEndedIsOver) {
    const Folder folder;
    const auto database = folder / "x.db";
    auto run = some_run();
    run.host = files::own_host();
    run.process = ::getpid();
    write_now(now_file(database), run);
    EXPECT_TRUE(read_now(database));
    const pid_t ended = ::fork();
    if (ended == 0) ::_exit(0);
    ::waitpid(ended, nullptr, 0);
    for (const std::int64_t process : {std::int64_t{ended}, std::int64_t{-1}, std::int64_t{1} << 40}) {
        run.process = process;
        write_now(now_file(database), run);
        EXPECT_FALSE(read_now(database)) << process;
    }
}

TEST(LiveNow, NeverStandsInThePlaceOfTheDatabase) {
    EXPECT_NE(now_file("/a/x.now"), fs::path("/a/x.now"));
    EXPECT_EQ(now_file("/a/x").extension(), ".now");
}

// A line break in a text cannot add a line of its own.
TEST(LiveNow, TextsStayOnTheirLine) {
    auto run = some_run();
    run.judgement = "good\nprocess 1\ncase x";
    run.running[0].host = "host\nquestions 7";
    const auto read = now_of(text_of(run));
    ASSERT_TRUE(read);
    EXPECT_EQ(read->process, 4711);
    EXPECT_EQ(read->questions, 100);
    EXPECT_EQ(read->judgement, "good process 1 case x");
    EXPECT_EQ(read->running.size(), 2u);
}

TEST(LiveNow, TextsOfOthersBreakNothing) {
    EXPECT_FALSE(now_of(""));
    EXPECT_FALSE(now_of("grainsweep now 2\nprocess 1\n"));
    EXPECT_FALSE(now_of(std::string(100, '\0')));
    const auto odd = now_of(
        "grainsweep now 1\nprocess -1e9\nquestions 99999999999999999999\ndecided 1x\nseconds nan\nseconds_left -\n"
        "case\ncase a\ncase a b 0.5 1 h\ncase a 1 half 1 h\nunknown word\n\n\n");
    ASSERT_TRUE(odd);
    EXPECT_EQ(odd->process, 0);
    EXPECT_EQ(odd->questions, 0);
    EXPECT_EQ(odd->decided, 0);
    ASSERT_EQ(odd->running.size(), 1u);
    EXPECT_FALSE(odd->running[0].share);
    const auto whole = text_of(some_run());
    for (std::size_t bytes = 0; bytes <= whole.size(); ++bytes) (void)now_of(whole.substr(0, bytes));
}

TEST(LiveNow, AFolderThatCannotBeWrittenIsPassedOver) {
    EXPECT_NO_THROW(write_now("/nowhere/x.now", some_run()));
}

}  // namespace grainsweep::tests::live_now_test
