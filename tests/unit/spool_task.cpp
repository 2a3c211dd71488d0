// The loop of a task with a scripted crew: no process, and what it leaves in the spool.
#include "sweep/spool/task.hpp"
#include "tests/support/archive.hpp"
#include "tests/support/scripted_crew.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

namespace grainsweep::tests::spool_task_test {

using namespace spool;
using campaign::Outcome;
using schedule::Ending;

class SpoolTask : public testing::Test {
protected:
    SpoolTask()
        : campaign(tests::small_campaign("spooled")),
          placed(tests::small_design(campaign, 5)),
          cases(placed),
          spool(folder / "spool", {folder.path(), hash_of_cases(cases), "{}"}, campaign.scene()) {}

    static workers::PoolEvent answered(const campaign::Attempt& attempt) {
        campaign::CaseResult result;
        result.attempt = attempt;
        result.observations.scalars["y"] = 1;
        return workers::Finished{result, false};
    }
    Ending run(ScriptedCrew& crew, TaskRules rules = {}) {
        rules.lease = std::min(rules.lease, 2.0);
        Task task(spool, cases, std::vector<double>(cases.size(), 1.0), crew, std::move(rules), {});
        const auto ending = task.run();
        tally = task.tally();
        return ending;
    }
    [[nodiscard]] campaign::CaseId id(std::size_t i) const { return placed[i].question.id; }
    [[nodiscard]] std::optional<Outcome> outcome(std::size_t i, std::int64_t attempt) const {
        const auto entry = spool.read({id(i), attempt});
        const auto* answer = entry ? std::get_if<Answer>(&*entry) : nullptr;
        return answer ? std::optional(answer->result.outcome) : std::nullopt;
    }

    tests::Folder folder;
    campaign::Campaign campaign;
    std::vector<campaign::PlacedCase> placed;
    campaign::Cases cases;
    Spool spool;
    Task::Tally tally;
};

TEST_F(SpoolTask, AnswersEveryCase) {
    ScriptedCrew crew(answered, 2);
    EXPECT_EQ(run(crew), Ending::finished);
    EXPECT_EQ(tally.computed, 5U);
    EXPECT_TRUE(crew.retired);
    for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(outcome(i, 1), Outcome::completed);
    ScriptedCrew again(answered);
    EXPECT_EQ(run(again), Ending::finished);
    EXPECT_TRUE(again.started.empty()) << "all have an answer";
    EXPECT_EQ(tally.answered, 5U);
}

TEST_F(SpoolTask, AFailureIsTriedAgainAsOftenAsAllTasksMay) {
    ScriptedCrew crew([&](const auto& attempt) -> workers::PoolEvent {
        if (attempt.case_id != id(2)) return answered(attempt);
        workers::Lost lost;
        lost.running = attempt;
        lost.reason = "worker ended by signal 11";
        return lost;
    });
    EXPECT_EQ(run(crew, {.share = {}, .attempts = 2}), Ending::finished);
    EXPECT_EQ(tally.failed, 1U);
    EXPECT_EQ(outcome(2, 1), Outcome::crashed);
    EXPECT_EQ(outcome(2, 2), Outcome::crashed);
    EXPECT_FALSE(spool.read({id(2), 3}));
    ScriptedCrew again(answered);
    EXPECT_EQ(run(again, {.share = {}, .attempts = 2}), Ending::finished);
    EXPECT_TRUE(again.started.empty()) << "other tasks know that it is given up";
    ScriptedCrew more(answered);
    EXPECT_EQ(run(more, {.share = {}, .attempts = 3}), Ending::finished);
    ASSERT_EQ(more.started.size(), 1U) << "where more tries are allowed there is one";
    EXPECT_EQ(more.started[0].number, 3);
}

TEST_F(SpoolTask, WhatIsGivenBackIsTakenAgainUnderAnotherNumber) {
    bool given_back = false;
    ScriptedCrew crew([&](const auto& attempt) -> workers::PoolEvent {
        if (!std::exchange(given_back, true)) return workers::GivenBack{attempt, "by a signal", 1, false, false};
        return answered(attempt);
    });
    EXPECT_EQ(run(crew), Ending::finished);
    ASSERT_GE(crew.started.size(), 6U);
    EXPECT_EQ(crew.started[0].case_id, crew.started[1].case_id);
    EXPECT_EQ(crew.started[1].number, 2) << "so that its worker looks for a checkpoint";
}

TEST_F(SpoolTask, WhatWasNeverBegunIsFreeAgain) {
    bool lost_once = false;
    ScriptedCrew crew(
        [&](const auto& attempt) -> workers::PoolEvent {
            if (std::exchange(lost_once, true)) return answered(attempt);
            workers::Lost lost;
            lost.running = attempt;
            lost.queued = {crew.waiting.begin() + 1, crew.waiting.end()};
            lost.from_outside = true;
            crew.waiting.resize(1);
            return lost;
        },
        3);
    EXPECT_EQ(run(crew), Ending::finished);
    EXPECT_EQ(tally.computed, 5U);
    for (const auto& attempt : crew.started)
        EXPECT_EQ(attempt.number, attempt.case_id == crew.started[0].case_id && attempt != crew.started[0] ? 2 : 1);
}

TEST_F(SpoolTask, TasksThatLiveAreNotWaitedFor) {
    const TaskFile other(spool, 2);
    ASSERT_TRUE(spool.claim({id(4), 1}, other.name()));
    ScriptedCrew crew(answered);
    crew.idle = [&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        std::filesystem::last_write_time(spool.task(other.name()), std::filesystem::file_time_type::clock::now());
    };
    EXPECT_EQ(run(crew), Ending::limited);
    EXPECT_EQ(tally.elsewhere, 1U);
    EXPECT_EQ(tally.computed, 4U);
}

TEST_F(SpoolTask, WhatATaskLeftBehindIsTakenOver) {
    std::string gone;
    {
        const TaskFile other(spool, 2);
        gone = other.name();
        ASSERT_TRUE(spool.claim({id(1), 1}, gone));
    }
    ScriptedCrew crew(answered);
    EXPECT_EQ(run(crew), Ending::finished);
    EXPECT_EQ(outcome(1, 2), Outcome::completed);
}

TEST_F(SpoolTask, NothingIsClaimedThatDoesNotFitIntoTheTimeLeft) {
    double left = 2.5;
    ScriptedCrew crew([&](const auto& attempt) {
        left -= 1;
        return answered(attempt);
    });
    EXPECT_EQ(run(crew, {.share = {}, .attempts = 3, .lease = 2, .walltime = {[&] { return left; }, 2.5, false, 0.1}}),
              Ending::out_of_time);
    EXPECT_EQ(tally.computed, 2U);
    EXPECT_EQ(tally.left_out, 3U);
    std::ptrdiff_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(spool.cases())) files += entry.is_regular_file();
    EXPECT_EQ(files, 2) << "no claim is left";
}

TEST_F(SpoolTask, AStopLeavesNoClaim) {
    ScriptedCrew crew([&, asked = false](const auto& attempt) mutable -> workers::PoolEvent {
        if (!std::exchange(asked, true)) return workers::Interrupted{false, true};
        return workers::GivenBack{attempt, "given back before it was finished", 1, true, false};
    });
    EXPECT_EQ(run(crew), Ending::asked_to_end);
    const auto entry = spool.read(crew.started.at(0));
    ASSERT_TRUE(entry);
    EXPECT_EQ(std::get<Answer>(*entry).result.outcome, Outcome::abandoned);
}

}  // namespace grainsweep::tests::spool_task_test
