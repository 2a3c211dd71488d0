// Threads on cores that are not alike: how long their parts take, and the shares of the work that let all end together.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <thread>
#include <vector>

#include "solver/threads/shares.hpp"
#include "solver/threads/thread_pool.hpp"
#include "stats/random.hpp"

namespace grainsweep::tests::thread_shares_test {

/// Rounds of a pool whose threads do `speed` of the work in a unit of time, within 2 % more or less each time.
class Rounds {
public:
    [[nodiscard]] std::vector<double> seconds(const Shares& shares, const std::vector<double>& speed, int rounds) {
        std::vector<double> mean(speed.size(), 0);
        for (int k = 0; k < rounds; ++k)
            for (std::size_t part = 0; part < speed.size(); ++part)
                mean[part] += shares.of(static_cast<int>(part)) / speed[part] *
                              (0.98 + 0.04 * noise_.uniform(counter_++)) / rounds;
        return mean;
    }

private:
    stats::Stream noise_{7, 0};
    std::uint64_t counter_ = 0;
};

/// How much longer the last one takes than all would with the best shares.
double excess(const Shares& shares, const std::vector<double>& speed) {
    double longest = 0;
    for (std::size_t part = 0; part < speed.size(); ++part)
        longest = std::max(longest, shares.of(static_cast<int>(part)) / speed[part]);
    return longest * std::accumulate(speed.begin(), speed.end(), 0.0) - 1;
}

TEST(ThreadShares, AreEqualAtFirstAndStaySoOnCoresThatAreAlike) {
    Shares shares(3);
    for (int part = 0; part < 3; ++part) EXPECT_EQ(shares.of(part), 1.0 / 3);
    Rounds rounds;
    for (int k = 0; k < 200; ++k) {
        shares.move(rounds.seconds(shares, {1, 1, 1}, 100));
        EXPECT_LT(excess(shares, {1, 1, 1}), 0.015) << "move " << k;
    }
}

TEST(ThreadShares, LetCoresThatAreNotAlikeEndTogether) {
    for (const std::vector<double>& speed :
         {std::vector<double>{1, 0.75}, {0.6, 1}, {1, 1, 0.6, 0.6}, {1, 0.9, 1.2, 1}}) {
        Shares shares(static_cast<int>(speed.size()));
        Rounds rounds;
        EXPECT_GT(excess(shares, speed), 0.1) << "before they move";
        for (int k = 0; k < 3; ++k) shares.move(rounds.seconds(shares, speed, 100));
        for (int k = 0; k < 100; ++k) {
            shares.move(rounds.seconds(shares, speed, 100));
            EXPECT_LT(excess(shares, speed), 0.02) << speed.size() << " parts, move " << k;
        }
    }
}

TEST(ThreadShares, FollowACoreThatIsDisturbedForAWhile) {
    Shares shares(2);
    Rounds rounds;
    for (const double speed : {1.0, 0.7, 1.0}) {
        for (int k = 0; k < 4; ++k) shares.move(rounds.seconds(shares, {1, speed}, 100));
        EXPECT_LT(excess(shares, {1, speed}), 0.01) << speed;
    }
}

TEST(ThreadShares, StayWithinBoundsAndAddUpToOne) {
    Shares shares(2);
    for (int k = 0; k < 100; ++k) shares.move(std::vector<double>{1, 100});
    EXPECT_NEAR(shares.of(0) + shares.of(1), 1, 1e-15);
    EXPECT_GE(shares.of(1), 0.2);
    EXPECT_LE(shares.of(0), 0.8);
    const double before = shares.of(0);
    shares.move({});
    EXPECT_EQ(shares.of(0), before);
}

TEST(ThreadShares, SixteenOfUnequalCoresAndCostsEndTogetherAfterTwoMoves) {
    std::vector<double> speed;
    for (int k = 0; k < 16; ++k) speed.push_back(0.7 + 0.04 * k);
    Shares shares(16);
    Rounds rounds;
    EXPECT_GT(excess(shares, speed), 0.4) << "before they move";
    for (int k = 0; k < 2; ++k) shares.move(rounds.seconds(shares, speed, 64));
    EXPECT_LT(excess(shares, speed), 0.05);
}

TEST(ThreadPool, TimesPartsFromTheBeginningOfARound) {
    ThreadPool pool(2);
    EXPECT_TRUE(pool.seconds(1).empty());
    pool.run([](int) {});
    EXPECT_TRUE(pool.seconds(1).empty()) << "a round that is not timed";
    // Each part waits for the other, so that two threads do them; the second goes on when the first has ended.
    constexpr int rounds = 25;
    for (int round = 0; round < rounds; ++round) {
        std::atomic<bool> first_ends = false, second_goes = false;
        pool.run_timed([&](int part) {
            if (part == 1) second_goes = true;
            while (part == 0 ? !second_goes : !first_ends) std::this_thread::yield();
            if (part == 0) first_ends = true;
            if (part == 1) std::this_thread::sleep_for(std::chrono::milliseconds(20));
        });
    }
    EXPECT_EQ(pool.timed_rounds(), rounds);
    const std::vector<double> seconds = pool.seconds(rounds);
    ASSERT_EQ(seconds.size(), 2U);
    EXPECT_GE(seconds[1], 0.02);
    EXPECT_LT(seconds[0], seconds[1]);
    EXPECT_TRUE(pool.seconds(rounds + 1).empty());
    pool.forget_times();
    EXPECT_TRUE(pool.seconds(1).empty());
}

}  // namespace grainsweep::tests::thread_shares_test
