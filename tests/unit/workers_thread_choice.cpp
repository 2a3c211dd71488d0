// How many threads a case uses on cores that are not equally fast: emulated ones, whose speed is a function.
#include <gtest/gtest.h>

#include <functional>

#include "sweep/workers/thread_choice.hpp"

namespace grainsweep::tests::workers_thread_choice_test {

/// Work of so many slices of a second each; `speed`: of so many threads.
double work_done(int slices, int allowed, const std::function<double(int)>& speed) {
    workers::ThreadChoice choice;
    double work = 0;
    for (int k = 0; k < slices; ++k) {
        const double done = speed(choice.next(allowed));
        choice.note(done, 1);
        work += done;
    }
    return work;
}

TEST(ThreadChoice, UsesAllThreadsWhereTheyAreFastest) {
    const auto near = [](int threads) { return threads / (1 + 0.05 * (threads - 1)); };
    EXPECT_GT(work_done(640, 16, near), 0.93 * 640 * near(16));
}

TEST(ThreadChoice, UsesHalfWhereAllWaitForOneAnother) {
    const auto far_apart = [](int threads) { return threads > 8 ? 3.0 : 0.8 * threads; };
    EXPECT_GT(work_done(640, 16, far_apart), 0.93 * 640 * far_apart(8));
}

TEST(ThreadChoice, UsesOneWhereTheOthersAreHeldUp) {
    const auto held_up = [](int threads) { return threads > 1 ? 0.3 : 1.0; };
    EXPECT_GT(work_done(640, 16, held_up), 0.93 * 640);
    EXPECT_GT(work_done(640, 2, held_up), 0.93 * 640);
}

TEST(ThreadChoice, FollowsCoresThatBecomeFreeAgain) {
    workers::ThreadChoice choice;
    for (int k = 0; k < 30; ++k) choice.note(choice.next(4) > 1 ? 0.3 : 1.0, 1);
    EXPECT_EQ(choice.next(4), 1);
    for (int k = 0; k < 80; ++k) choice.note(choice.next(4), 1);
    EXPECT_EQ(choice.next(4), 4);
}

TEST(ThreadChoice, TriesAgainWithTwiceAsManyThreads) {
    workers::ThreadChoice choice;
    EXPECT_EQ(choice.next(1), 1);
    choice.note(1, 1);
    for (int k = 0; k < 30; ++k) choice.note(choice.next(2) > 1 ? 0.3 : 1.0, 1);
    EXPECT_EQ(choice.next(2), 1);
    EXPECT_EQ(choice.next(3), 1);
    EXPECT_EQ(choice.next(16), 16);
}

/// The last case of a campaign, whose threads grow as other cases end: trials cost it little.
TEST(ThreadChoice, ACaseThatGetsMoreAndMoreThreadsUsesThem) {
    const auto near = [](int threads) { return threads / (1 + 0.05 * (threads - 1)); };
    workers::ThreadChoice choice;
    double done = 0, best = 0;
    for (int k = 0; k < 60; ++k) {
        const int allowed = k < 10 ? 1 : k < 20 ? 2 : k < 30 ? 5 : 16;
        const double work = near(choice.next(allowed));
        choice.note(work, 1);
        done += work;
        best += near(allowed);
    }
    EXPECT_GT(done, 0.93 * best);
}

}  // namespace grainsweep::tests::workers_thread_choice_test
