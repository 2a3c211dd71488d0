// Threads on cores that are not alike: which of them end late, and the shares of the work that let all end together.
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
    [[nodiscard]] std::vector<double> lateness(const Shares& shares, const std::vector<double>& speed, int rounds) {
        const std::size_t n = speed.size();
        std::vector<double> late(n, 0), end(n);
        std::vector<std::size_t> order(n);
        for (int k = 0; k < rounds; ++k) {
            for (std::size_t part = 0; part < n; ++part)
                end[part] =
                    shares.of(static_cast<int>(part)) / speed[part] * (0.98 + 0.04 * noise_.uniform(counter_++));
            std::iota(order.begin(), order.end(), std::size_t{0});
            std::ranges::sort(order, {}, [&](std::size_t part) { return end[part]; });
            for (std::size_t place = 0; place < n; ++place)
                late[order[place]] += (2 * static_cast<double>(place) / static_cast<double>(n - 1) - 1) / rounds;
        }
        return late;
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
        shares.move(rounds.lateness(shares, {1, 1, 1}, 100));
        EXPECT_LT(excess(shares, {1, 1, 1}), 0.015) << "move " << k;
    }
}

TEST(ThreadShares, LetCoresThatAreNotAlikeEndTogether) {
    for (const std::vector<double>& speed :
         {std::vector<double>{1, 0.75}, {0.6, 1}, {1, 1, 0.6, 0.6}, {1, 0.9, 1.2, 1}}) {
        Shares shares(static_cast<int>(speed.size()));
        Rounds rounds;
        EXPECT_GT(excess(shares, speed), 0.1) << "before they move";
        for (int k = 0; k < 12; ++k) shares.move(rounds.lateness(shares, speed, 100));
        for (int k = 0; k < 100; ++k) {
            shares.move(rounds.lateness(shares, speed, 100));
            EXPECT_LT(excess(shares, speed), 0.02) << speed.size() << " parts, move " << k;
        }
    }
}

TEST(ThreadShares, FollowACoreThatIsDisturbedForAWhile) {
    Shares shares(2);
    Rounds rounds;
    for (const double speed : {1.0, 0.7, 1.0}) {
        for (int k = 0; k < 15; ++k) shares.move(rounds.lateness(shares, {1, speed}, 100));
        EXPECT_LT(excess(shares, {1, speed}), 0.01) << speed;
    }
}

TEST(ThreadShares, StayWithinBoundsAndAddUpToOne) {
    Shares shares(2);
    for (int k = 0; k < 100; ++k) shares.move(std::vector<double>{-1, 1});
    EXPECT_NEAR(shares.of(0) + shares.of(1), 1, 1e-15);
    EXPECT_GE(shares.of(1), 0.2);
    EXPECT_LE(shares.of(0), 0.8);
    const double before = shares.of(0);
    shares.move({});
    EXPECT_EQ(shares.of(0), before);
}

TEST(ThreadPool, KnowsWhichPartsEndLate) {
    ThreadPool pool(2);
    EXPECT_TRUE(pool.lateness(1).empty());
    pool.run([](int) {});
    EXPECT_TRUE(pool.lateness(1).empty()) << "a round that is not compared";
    // Each part waits for the other, so that two threads do them; the second goes on for longer than a busy machine
    // keeps the first one waiting.
    for (int round = 0; round < 25; ++round) {
        std::atomic<bool> first_goes = false, second_goes = false;
        pool.run_compared([&](int part) {
            (part == 0 ? first_goes : second_goes) = true;
            while (!first_goes || !second_goes) std::this_thread::yield();
            if (part == 1) std::this_thread::sleep_for(std::chrono::milliseconds(20));
        });
    }
    const std::vector<double> late = pool.lateness(20);  // of the last round a thread may still be counting
    ASSERT_EQ(late.size(), 2U);
    EXPECT_LT(late[0], -0.5);
    EXPECT_GT(late[1], 0.5);
    EXPECT_TRUE(pool.lateness(20).empty()) << "counted twice";
}

}  // namespace grainsweep::tests::thread_shares_test
