// The protocol of message.hpp, state by state: what a worker may write when, and what becomes of its cases.
#include "sweep/workers/worker_state.hpp"

#include "sweep/workers/awake_clock.hpp"
#include "sweep/workers/line_buffer.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <vector>

namespace grainsweep::tests::workers_state_test {

using namespace workers;
using campaign::Outcome;
using Phase = WorkerState::Phase;
using Overdue = WorkerState::Overdue;

const campaign::Attempt first{"a", 1}, second{"b", 1};

class Worker : public testing::Test {
protected:
    Worker()
        : expected{{"1.0", "abc", "feed", "avx2", "its processor", "its host"},
                   {{"y", "", "", Shape::scalar}, {"s", "", "", Shape::series}}} {}

    WorkerState::Meaning say(const ToBoss& message, double now = 0) { return state.receive(encode(message), now); }
    std::string complaint(const ToBoss& message) {
        const auto meaning = say(message);
        const auto* found = std::get_if<WorkerState::Complaint>(&meaning);
        return found == nullptr ? "" : found->why;
    }
    void get_ready(double now = 0) {
        ASSERT_EQ(say(Ready{protocol_number, {"1.0", "abc", "feed", "baseline", "its own", "node"}}, now).index(), 0U);
    }
    static Done done(const campaign::Attempt& attempt, Outcome outcome = Outcome::completed) {
        Done message;
        message.result.attempt = attempt;
        message.result.outcome = outcome;
        message.result.observations.scalars["y"] = 1;
        return message;
    }

    Expected expected;
    WorkerState state{expected, 0};
};

TEST_F(Worker, TakesCasesOnceItIsReadyAndSaysWhatItIs) {
    EXPECT_EQ(state.phase(), Phase::starting);
    get_ready();
    EXPECT_EQ(state.phase(), Phase::serving);
    EXPECT_EQ(state.computer()->host, "node");
    EXPECT_EQ(state.computer()->instruction_path, "baseline") << "its own, not that of the main program";
    EXPECT_NE(complaint(Ready{protocol_number, expected.program}), "") << "twice";
}

TEST_F(Worker, OfAnotherBuildIsRefused) {
    for (const auto& other :
         {campaign::Computer{"1.1", "abc", "feed", "", "", ""}, campaign::Computer{"1.0", "abd", "feed", "", "", ""},
          campaign::Computer{"1.0", "abc", "face", "", "", ""}}) {
        EXPECT_NE(complaint(Ready{protocol_number, other}).find("the main program is 1.0 (abc, build feed)"),
                  std::string::npos);
        EXPECT_FALSE(state.was_ready());
    }
    EXPECT_NE(complaint(Ready{1, expected.program}).find("with protocol 1"), std::string::npos);
}

TEST_F(Worker, ThatAnswersBeforeItIsReadyIsRefused) {
    for (const ToBoss& message : std::vector<ToBoss>{Begun{first}, Alive{first, 0.5}, done(first), GiveBack{first, ""}})
        EXPECT_EQ(complaint(message), "the worker answered before it was ready");
}

TEST_F(Worker, NothingItWritesCountsAfterItIsDismissed) {
    get_ready();
    state.give(first, 0);
    say(Begun{first});
    state.dismiss();
    EXPECT_TRUE(std::holds_alternative<WorkerState::Nothing>(say(done(first))));
    EXPECT_EQ(state.running(), first) << "the case is still in its account";
}

TEST_F(Worker, AnswersOneCaseAfterTheOther) {
    get_ready();
    state.give(first, 0);
    state.give(second, 0);
    EXPECT_FALSE(state.running());
    EXPECT_EQ(state.waiting(), (std::vector{first, second}));
    EXPECT_NE(complaint(done(first)), "") << "not begun";
    EXPECT_NE(complaint(Begun{second}), "") << "not its turn";
    say(Begun{first, true}, 3);
    EXPECT_EQ(state.running(), first);
    EXPECT_TRUE(state.resumed());
    EXPECT_EQ(state.waiting(), std::vector{second});
    EXPECT_DOUBLE_EQ(state.running_seconds(5), 2);
    EXPECT_NE(complaint(Begun{second}), "") << "two at a time";
    EXPECT_NE(complaint(Alive{second, 0.1}), "");
    const auto beat = say(Alive{first, 0.1});
    EXPECT_EQ(std::get<Heartbeat>(beat).progress, 0.1);
    const auto meaning = say(done(first));
    EXPECT_EQ(std::get<Finished>(meaning).result.observations.scalars.at("y"), 1);
    EXPECT_FALSE(state.running());
    EXPECT_EQ(state.cases(), 1U);
    EXPECT_NE(complaint(done(first)), "") << "twice";
}

TEST_F(Worker, NumbersOfAFailureAreDropped) {
    for (const auto outcome : {Outcome::crashed, Outcome::timed_out, Outcome::unstable, Outcome::rejected}) {
        WorkerState fresh{expected, 0};
        std::swap(state, fresh);
        get_ready();
        state.give(first, 0);
        say(Begun{first});
        const auto meaning = say(done(first, outcome));
        EXPECT_TRUE(std::get<Finished>(meaning).result.observations.scalars.empty());
    }
}

TEST_F(Worker, MayNotAnswerAbandonedNorWhatTheSceneDoesNotMeasure) {
    get_ready();
    state.give(first, 0);
    say(Begun{first});
    EXPECT_NE(complaint(done(first, Outcome::abandoned)), "");
    auto unknown = done(first);
    unknown.result.observations.scalars["z"] = 1;
    EXPECT_NE(complaint(unknown).find("'z'"), std::string::npos);
    auto without_name = done(first);
    without_name.result.observations.scalars[""] = 1;
    EXPECT_NE(complaint(without_name), "");
    auto wrong_shape = done(first);
    wrong_shape.result.observations.series["y"] = {{.time = 0, .value = 1}};
    EXPECT_NE(complaint(wrong_shape).find("'y'"), std::string::npos);
}

TEST_F(Worker, LeavesWhenItGivesBack) {
    get_ready();
    state.give(first, 0);
    state.give(second, 0);
    say(Begun{first}, 1);
    const auto running = say(GiveBack{first, "signal 15"}, 3);
    EXPECT_EQ(std::get<GivenBack>(running).reason, "signal 15");
    EXPECT_DOUBLE_EQ(std::get<GivenBack>(running).seconds, 2);
    EXPECT_FALSE(std::get<GivenBack>(running).asked);
    EXPECT_EQ(state.phase(), Phase::leaving);
    const auto waiting = say(GiveBack{second, "signal 15"}, 3);
    EXPECT_DOUBLE_EQ(std::get<GivenBack>(waiting).seconds, 0);
    EXPECT_TRUE(std::holds_alternative<WorkerState::Nothing>(state.receive("tidied up", 3))) << "its launcher's";
}

TEST_F(Worker, MayFinishWhatItHasAfterAStop) {
    get_ready();
    state.give(first, 0);
    say(Begun{first});
    state.stop();
    EXPECT_EQ(state.phase(), Phase::leaving);
    EXPECT_TRUE(std::holds_alternative<Finished>(say(done(first))));
}

TEST_F(Worker, MayFollowABannerButWritesNoNonsense) {
    const auto banner = state.receive("Welcome to node 3", 0);
    EXPECT_EQ(std::get<WorkerState::Banner>(banner).line, "Welcome to node 3");
    EXPECT_EQ(state.phase(), Phase::starting);
    get_ready();
    const auto meaning = state.receive("Welcome to node 3", 0);
    EXPECT_NE(std::get<WorkerState::Complaint>(meaning).why.find("Welcome to node 3"), std::string::npos);
}

TEST_F(Worker, BannersAndHeartbeatsHaveAnEnd) {
    int banners = 0;
    while (std::holds_alternative<WorkerState::Banner>(state.receive(std::string(100, 'x'), 0)) && banners < 10'000)
        ++banners;
    EXPECT_LT(banners, 1000);
    EXPECT_LT(state.banner().size(), 2000U);

    WorkerState fresh{expected, 0};
    std::swap(state, fresh);
    get_ready();
    state.give(first, 0);
    say(Begun{first});
    // What a pipe held while the main program was stopped.
    for (int second_number = 0; second_number < 10; ++second_number) {
        for (int k = 0; k < 800; ++k)
            ASSERT_TRUE(std::holds_alternative<Heartbeat>(say(Alive{first, 0.1}, 2 * second_number)));
    }
    int beats = 0;
    while (std::holds_alternative<Heartbeat>(say(Alive{first, 0.1}, 100)) && beats < 1'000'000) ++beats;
    EXPECT_LT(beats, 20'000);
}

TEST_F(Worker, IsWaitedForOnlyWhileSomethingIsExpected) {
    const TimeLimits limits{.wall = 5, .start = 10, .silence = 3};
    EXPECT_EQ(state.overdue(limits, 9), Overdue::nothing);
    EXPECT_EQ(state.overdue(limits, 11), Overdue::start);
    EXPECT_EQ(state.overdue({.wall = 5, .start = {}, .silence = 3}, 1e9), Overdue::nothing);
    get_ready(9);
    EXPECT_EQ(state.overdue(limits, 1000), Overdue::nothing) << "it has nothing to do";
    state.give(first, 1000);
    EXPECT_EQ(state.overdue(limits, 1002), Overdue::nothing);
    EXPECT_EQ(state.overdue(limits, 1004), Overdue::silence) << "it did not begin";
    say(Begun{first}, 1001);
    say(Alive{first, 0.1}, 1003);
    EXPECT_EQ(state.overdue(limits, 1005), Overdue::nothing);
    say(Alive{first, 0.2}, 1005.5);
    EXPECT_EQ(state.overdue(limits, 1006.5), Overdue::answer);
}

TEST(LineBuffer, PutsLinesTogether) {
    LineBuffer buffer(10);
    std::vector<std::string> lines;
    const auto take = [&](std::string_view line) {
        lines.emplace_back(line);
        return true;
    };
    EXPECT_TRUE(buffer.feed("one\ntw", take));
    EXPECT_TRUE(buffer.feed("", take));
    EXPECT_TRUE(buffer.feed("o\n\nthree", take));
    EXPECT_EQ(lines, (std::vector<std::string>{"one", "two", ""}));
    EXPECT_EQ(buffer.begun(), "three");
    EXPECT_TRUE(buffer.feed("45678", take)) << "just as long as it may be";
    EXPECT_FALSE(buffer.feed("9", take));
    LineBuffer other(3);
    EXPECT_FALSE(other.feed("four\n", take)) << "also where its end is there";
}

TEST(LineBuffer, StopsWhereItIsTold) {
    LineBuffer buffer(100);
    int lines = 0;
    EXPECT_TRUE(buffer.feed("a\nb\nc\n", [&](std::string_view) { return ++lines < 2; }));
    EXPECT_EQ(lines, 2);
}

TEST(Shortened, CutsBetweenCharacters) {
    EXPECT_EQ(shortened("abc", 3), "abc");
    EXPECT_EQ(shortened("abcd", 3), "abc ...");
    EXPECT_EQ(shortened("ab\xc3\xa4z", 3), "ab ...");
}

TEST(AwakeClock, DoesNotCountWhatItSpentStopped) {
    using namespace std::chrono_literals;
    std::chrono::steady_clock::time_point moment{};
    AwakeClock clock(moment);
    EXPECT_DOUBLE_EQ(clock.at(moment += 125ms), 0.125);
    EXPECT_DOUBLE_EQ(clock.at(moment += 125ms), 0.25);
    EXPECT_DOUBLE_EQ(clock.at(moment += 1min), 0.5) << "a gap counts as a quarter of a second at most";
    EXPECT_DOUBLE_EQ(clock.at(moment += 125ms), 0.625);
}

}  // namespace grainsweep::tests::workers_state_test
