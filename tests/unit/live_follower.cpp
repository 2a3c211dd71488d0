// The follower reports each result of a database once, however the database grows.
#include "sweep/live/follower.hpp"
#include "tests/support/archive.hpp"
#include "tests/support/written.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace grainsweep::tests::live_follower_test {

namespace fs = std::filesystem;
using campaign::Outcome;
using live::Follower;
using store::Store;
using Json = nlohmann::ordered_json;

struct LiveFollower : testing::Test {
    Folder folder;
    campaign::Campaign asked = small_campaign("first");
    std::vector<campaign::PlacedCase> cases = small_design(asked, 40);
    Store store{folder / "a.db", Store::Mode::create};

    LiveFollower() { (void)store.enrol(asked, cases, here()); }

    void finish(std::size_t k, std::int64_t attempt, Outcome outcome, double seconds, const std::string& message = "") {
        auto result = answer(cases[k].question, attempt);
        result.outcome = outcome;
        result.cost.wall_seconds = seconds;
        result.message = message;
        if (outcome != Outcome::completed) result.observations = {};
        store.group([&] { EXPECT_TRUE(store.finish(result)); });
    }
    void begin(std::size_t k, std::int64_t attempt) {
        store.group([&] { store.begin({cases[k].question.id, attempt}); });
    }
    [[nodiscard]] std::string id(std::size_t k) const { return cases[k].question.id; }
};

/// Polls until something comes, for cases that are looked at now and then only.
std::vector<Json> awaited(Follower& follower) {
    const auto last = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    std::vector<Json> results;
    while (results.empty() && std::chrono::steady_clock::now() < last)
        for (const auto& one : follower.poll()) results.push_back(Json::parse(one.text()));
    return results;
}

TEST_F(LiveFollower, TellsWhatIsNewAndOnlyOnce) {
    settle(store, cases[0].question, 1);
    Follower follower(folder / "a.db");
    EXPECT_TRUE(follower.poll().empty()) << "settled before";
    settle(store, cases[7].question, 1);
    settle(store, cases[3].question, 1);
    const auto told = follower.poll();
    ASSERT_EQ(told.size(), 2u);
    const auto first = Json::parse(told[0].text());
    EXPECT_EQ(first["case"], id(3));
    EXPECT_EQ(first["outcome"], "completed");
    EXPECT_EQ(first["attempts"], 1);
    EXPECT_EQ(first["values"]["y"], answer(cases[3].question, 1).observations.scalars.at("y"));
    EXPECT_FALSE(first.contains("reason"));
    EXPECT_TRUE(follower.poll().empty());
}

TEST_F(LiveFollower, TellsEveryCaseOfALongRunInWhateverOrderTheyEnd) {
    Follower follower(folder / "a.db");
    std::multiset<std::string> told;
    for (std::size_t k = 0; k < cases.size(); ++k) {
        settle(store, cases[(k * 17) % cases.size()].question, 1);
        if (k % 3 == 0)
            for (const auto& one : follower.poll()) told.insert(Json::parse(one.text())["case"]);
    }
    for (const auto& one : follower.poll()) told.insert(Json::parse(one.text())["case"]);
    EXPECT_EQ(told.size(), cases.size());
    for (std::size_t k = 0; k < cases.size(); ++k) EXPECT_EQ(told.count(id(k)), 1u) << k;
}

// The number of attempts grows when an attempt begins, the outcome changes when it ends.
TEST_F(LiveFollower, ACaseThatFailsAndIsTriedAgainIsToldTwice) {
    Follower follower(folder / "a.db");
    begin(2, 1);
    EXPECT_TRUE(follower.poll().empty());
    finish(2, 1, Outcome::crashed, 0.5, "it <b>broke</b>");
    auto told = follower.poll();
    ASSERT_EQ(told.size(), 1u);
    EXPECT_EQ(Json::parse(told[0].text())["outcome"], "crashed");
    EXPECT_EQ(Json::parse(told[0].text())["reason"], "it <b>broke</b>");
    EXPECT_TRUE(Json::parse(told[0].text())["values"].empty());
    begin(2, 2);
    EXPECT_TRUE(follower.poll().empty()) << "it only runs again";
    finish(2, 2, Outcome::crashed, 0.75, "again");
    EXPECT_EQ(follower.poll().size(), 1u) << "another failure";
    begin(2, 3);
    finish(2, 3, Outcome::completed, 1);
    told = follower.poll();
    ASSERT_EQ(told.size(), 1u);
    EXPECT_EQ(Json::parse(told[0].text())["outcome"], "completed");
    EXPECT_EQ(Json::parse(told[0].text())["attempts"], 3);
}

TEST_F(LiveFollower, ACaseThatIsAskedAgainBeforeTheFirstOpenOneIsToldToo) {
    for (std::size_t k = 0; k < 20; ++k) settle(store, cases[k].question, 1);
    begin(20, 1);
    finish(20, 1, Outcome::timed_out, 9);
    Follower follower(folder / "a.db");
    begin(20, 2);
    finish(20, 2, Outcome::completed, 1);
    auto told = awaited(follower);
    ASSERT_EQ(told.size(), 1u);
    EXPECT_EQ(told[0]["outcome"], "completed");
    begin(5, 2);
    finish(5, 2, Outcome::completed, 7);
    told = awaited(follower);
    ASSERT_EQ(told.size(), 1u);
    EXPECT_EQ(told[0]["case"], id(5));
}

TEST_F(LiveFollower, TellsNoMoreAtOnceThanAReaderTakes) {
    auto large = small_campaign("large");
    const auto many = small_design(large, 6001);
    (void)store.enrol(large, many, here());
    Follower follower(folder / "a.db");
    store.group([&] {
        for (const auto& one : many) {
            store.begin({one.question.id, 1});
            EXPECT_TRUE(store.finish(answer(one.question, 1)));
        }
    });
    std::multiset<std::string> told;
    for (int polls = 0; polls < 3; ++polls) {
        const auto results = follower.poll();
        EXPECT_LE(results.size(), Follower::most_at_once);
        for (const auto& one : results) told.insert(Json::parse(one.text())["case"]);
    }
    EXPECT_EQ(told.size(), many.size());
    EXPECT_EQ(std::set(told.begin(), told.end()).size(), many.size());
}

TEST_F(LiveFollower, NoticesThatTheFileIsGone) {
    const Follower follower(folder / "a.db");
    EXPECT_TRUE(follower.in_place());
    fs::rename(folder / "a.db", folder / "b.db");
    EXPECT_FALSE(follower.in_place());
}

}  // namespace grainsweep::tests::live_follower_test
