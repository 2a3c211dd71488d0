// Which cores go to which of the cases that run.
#include "sweep/workers/core_sharing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace grainsweep::tests::workers_core_sharing_test {

using namespace workers;
using testing::ElementsAre;
using testing::IsEmpty;

TEST(SharedCores, ACaseHasOneWhileOthersWait) {
    EXPECT_THAT(shared_cores(4, 10, std::vector{5.0, 5.0, 5.0, 5.0}), ElementsAre(1, 1, 1, 1));
    EXPECT_THAT(shared_cores(4, 10, std::vector{5.0}), ElementsAre(1)) << "the others are about to begin";
    EXPECT_THAT(shared_cores(2, 0, std::vector{5.0, 5.0, 5.0}), ElementsAre(1, 1, 1));
    EXPECT_THAT(shared_cores(8, 0, {}), IsEmpty());
}

TEST(SharedCores, WhatIsLeftOverGoesToThoseThatRunTheLongestFirst) {
    EXPECT_THAT(shared_cores(4, 0, std::vector{5.0, 7.0}), ElementsAre(2, 2));
    EXPECT_THAT(shared_cores(4, 0, std::vector{5.0}), ElementsAre(4));
    EXPECT_THAT(shared_cores(8, 0, std::vector{5.0, 7.0, 6.0}), ElementsAre(2, 3, 3));
    EXPECT_THAT(shared_cores(4, 0, std::vector{1.0, 1.0, 1.0}), ElementsAre(2, 1, 1))
        << "of equally long ones the first";
    EXPECT_THAT(shared_cores(4, 1, std::vector{5.0}), ElementsAre(3)) << "one is kept for the case that waits";
    EXPECT_THAT(shared_cores(8, 3, std::vector{5.0, 7.0}), ElementsAre(2, 3));
}

TEST(SharedCores, NeverMoreThanThereAreNorFewerThanOneEach) {
    for (std::size_t cores = 1; cores < 20; ++cores)
        for (std::size_t cases = 1; cases < 20; ++cases)
            for (std::size_t waiting = 0; waiting < 5; ++waiting) {
                const auto threads = shared_cores(cores, waiting, std::vector<double>(cases, 1.0));
                ASSERT_EQ(threads.size(), cases);
                ASSERT_GE(*std::ranges::min_element(threads), 1);
                const auto all = static_cast<std::size_t>(std::accumulate(threads.begin(), threads.end(), 0L));
                ASSERT_LE(all, std::max(cores, cases));
                ASSERT_TRUE(waiting > 0 || cores < cases || all == cores);
            }
}

/// Keeps what is written to it.
class WrittenTo final : public workers::Process {
public:
    explicit WrittenTo(std::size_t node) : node_(node) {}
    void listen(Listener) override {}
    void write(std::string line) override { lines.push_back(std::move(line)); }
    [[nodiscard]] bool everything_is_written() const override { return true; }
    void close() override {}
    void signal(int) override {}
    [[nodiscard]] bool runs() override { return true; }
    void wait(std::chrono::milliseconds) override {}
    [[nodiscard]] int status() const override { return 0; }
    [[nodiscard]] std::string end() const override { return {}; }
    [[nodiscard]] std::size_t node() const override { return node_; }
    [[nodiscard]] std::string id() const override { return "1"; }
    [[nodiscard]] const std::string& log() override { return log_; }

    std::vector<std::string> lines;

private:
    std::size_t node_;
    std::string log_;
};

class CoreSharingTest : public testing::Test {
protected:
    void add_worker(std::size_t node = 0) {
        workers.push_back(std::make_shared<PoolWorker>(std::make_shared<WrittenTo>(node), expected, 0));
        ASSERT_TRUE(std::holds_alternative<WorkerState::Nothing>(
            workers.back()->state.receive(encode(Ready{protocol_number, expected.program}), 0)));
    }
    void give(std::size_t worker, const std::string& id) { workers[worker]->state.give({id, 1}, 0); }
    void end(std::size_t worker, const std::string& id) {
        (void)workers[worker]->state.receive(encode(Begun{{id, 1}}), 0);
        Done done;
        done.result.attempt = {id, 1};
        (void)workers[worker]->state.receive(encode(done), 0);
    }
    void share(CoreSharing& sharing, std::size_t waiting) {
        sharing.share(workers, waiting, [](const campaign::Attempt&) { return 1.0; });
    }
    std::vector<std::string> told(std::size_t worker) {
        return std::exchange(static_cast<WrittenTo&>(*workers[worker]->child).lines, {});
    }

    Expected expected;
    std::vector<std::shared_ptr<PoolWorker>> workers;
};

TEST_F(CoreSharingTest, CoresGoToTheLastCaseAndComeBack) {
    CoreSharing sharing({}, 2);
    add_worker(), add_worker();
    give(0, "a"), give(1, "b");
    share(sharing, 3);
    share(sharing, 0);
    EXPECT_THAT(told(0), IsEmpty());
    EXPECT_THAT(told(1), IsEmpty());
    end(0, "a");
    share(sharing, 0);
    EXPECT_THAT(told(1), ElementsAre("{\"threads\":2}\n"));
    share(sharing, 0);
    EXPECT_THAT(told(1), IsEmpty()) << "it knows";
    give(0, "c");  // one that came back
    share(sharing, 0);
    EXPECT_THAT(told(1), ElementsAre("{\"threads\":1}\n"));
    EXPECT_THAT(told(0), IsEmpty());
    end(1, "b");
    share(sharing, 0);
    EXPECT_THAT(told(0), ElementsAre("{\"threads\":2}\n"));
}

TEST_F(CoreSharingTest, EveryNodeHasItsOwn) {
    CoreSharing sharing({}, 2);
    add_worker(1), add_worker(1), add_worker(2), add_worker(2);
    give(0, "a"), give(1, "b"), give(2, "c");
    share(sharing, 0);
    EXPECT_THAT(told(0), IsEmpty());
    EXPECT_THAT(told(1), IsEmpty());
    EXPECT_THAT(told(2), ElementsAre("{\"threads\":2}\n"));
    share(sharing, 1);
    EXPECT_THAT(told(2), ElementsAre("{\"threads\":1}\n")) << "another case could begin beside it";
}

TEST_F(CoreSharingTest, AFixedNumberIsToldOnceAndKept) {
    CoreSharing sharing(3, 4);
    add_worker();
    sharing.begin(*workers[0]);
    EXPECT_THAT(told(0), ElementsAre("{\"threads\":3}\n"));
    give(0, "a");
    share(sharing, 0);
    end(0, "a");
    sharing.begin(*workers[0]);
    EXPECT_THAT(told(0), IsEmpty());
}

}  // namespace grainsweep::tests::workers_core_sharing_test
