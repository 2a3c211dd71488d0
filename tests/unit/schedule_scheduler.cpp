// The loop with a scripted crew: no process, no clock.
#include "tests/support/scheduler_loop.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace grainsweep::tests::schedule_scheduler_test {

using namespace schedule;
using campaign::Outcome;

TEST_F(SchedulerLoop, RecordsEveryAnswer) {
    ScriptedCrew crew([](const auto& attempt) { return completed(attempt); }, 3);
    EXPECT_EQ(run(crew), Ending::finished);
    EXPECT_EQ(crew.started.size(), 10U);
    EXPECT_EQ(stored("completed"), 10);
    EXPECT_TRUE(crew.retired);
}

TEST_F(SchedulerLoop, CoresAreSharedByWhatWaitsAndWhatIsLeft) {
    bool told = false;
    ScriptedCrew crew(
        [&](const auto& attempt) -> workers::PoolEvent {
            if (!std::exchange(told, true)) return workers::Heartbeat{attempt, 0.25};
            return completed(attempt);
        },
        3);
    EXPECT_EQ(run(crew), Ending::finished);
    ASSERT_GE(crew.shared.size(), 11U);
    EXPECT_EQ(crew.shared.front(), (std::pair<std::size_t, double>(7, 1.0)));
    EXPECT_EQ(crew.shared[1].second, 0.75) << "a quarter is done";
    EXPECT_EQ(crew.shared.back().first, 0U);
}

// The recorder enters the rest between the answers, on a thread of its own.
TEST_F(SchedulerLoop, ALongCampaignIsEnteredWhileItsFirstCasesRun) {
    placed.clear();
    for (int point = 0; point < 20'000; ++point) {
        Inputs inputs = campaign.scene().defaults();
        inputs["x1"] = point / 20'000.0;
        placed.push_back({campaign::make_case(campaign.scene(), inputs, 1), point, 0, 0});
    }
    ScriptedCrew crew([](const auto& attempt) { return completed(attempt); }, 3);
    EXPECT_EQ(run(crew, {.max_cases = 50}, {}, nullptr, 10), Ending::limited);
    EXPECT_FALSE(store.enrols()) << "what is not computed is entered all the same";
    EXPECT_EQ(std::get<std::int64_t>(store.query("SELECT count(*) FROM loop").rows.at(0).at(0)), 20'000);
    EXPECT_EQ(stored("completed"), 50);
    EXPECT_TRUE(store.verify().empty());
}

TEST_F(SchedulerLoop, ALostWorkersCaseIsTriedAgainAndItsQueueCostsNothing) {
    int losses = 0;
    ScriptedCrew crew(
        [&](const auto& attempt) -> workers::PoolEvent {
            if (losses < 2 && attempt.case_id == placed[0].question.id) {
                ++losses;
                workers::Lost lost;
                lost.running = attempt;
                lost.reason = "worker ended by signal 9 (Killed)";
                return lost;
            }
            return completed(attempt);
        },
        1);
    EXPECT_EQ(run(crew), Ending::finished);
    EXPECT_EQ(stored("completed"), 10);
    const auto attempts = store.attempts(placed[0].question.id);
    ASSERT_EQ(attempts.size(), 3U);
    EXPECT_EQ(attempts[0].outcome, Outcome::crashed);
    EXPECT_NE(attempts[0].message.find("signal 9"), std::string::npos);
    EXPECT_EQ(attempts[2].outcome, Outcome::completed);
}

TEST_F(SchedulerLoop, ASecondInterruptEndsAtOnceAndTheNextRunGoesOn) {
    int after = 0;
    ScriptedCrew parking(
        [&](const auto& attempt) -> workers::PoolEvent {
            if (++after == 4) return workers::Interrupted{true};
            return completed(attempt);
        },
        1);
    EXPECT_EQ(run(parking), Ending::interrupted);
    EXPECT_TRUE(parking.dismissed);
    EXPECT_EQ(stored("completed"), 3);

    ScriptedCrew second([](const auto& attempt) { return completed(attempt); });
    EXPECT_EQ(run(second), Ending::finished);
    EXPECT_EQ(second.started.size(), 7U);
    EXPECT_EQ(stored("completed"), 10);
    EXPECT_EQ(second.started.front().number, 2);  // the attempt that was under way is not counted twice
}

TEST_F(SchedulerLoop, AnInterruptThatLeavesNothingIsNone) {
    bool interrupted = false;
    ScriptedCrew crew([&](const auto& attempt) -> workers::PoolEvent {
        if (attempt.case_id == placed[9].question.id && !std::exchange(interrupted, true))
            return workers::Interrupted{};
        return completed(attempt);
    });
    EXPECT_EQ(run(crew), Ending::finished);
    EXPECT_EQ(stored("completed"), 10);
}

// The last answers come after the interrupt and complete the block on which the rule stops.
TEST_F(SchedulerLoop, ConvergenceFoundWhileStoppingIsStored) {
    campaign.convergence = {"y", "all_change", {"mean"}, 0.01, 3, true};
    const auto judge = [&] {
        return Judge(*campaign.convergence, placed, 1, std::vector<double>(placed.size(), std::nan("")), 10);
    };
    const auto nearly_equal = [&](const campaign::Attempt& attempt) {
        const auto place =
            std::ranges::find(placed, attempt.case_id, [](const campaign::PlacedCase& one) { return one.question.id; });
        return completed(attempt, 1 + 1e-4 * static_cast<double>(place->point));
    };
    Judge undisturbed = judge();
    ScriptedCrew calm(nearly_equal, 2);
    EXPECT_EQ(run(calm, {}, {}, &undisturbed), Ending::converged);
    const auto stopped = store.campaigns().at(0).stopped_at;
    ASSERT_TRUE(stopped && *stopped < 10);

    store = store::Store(folder / "other.db", store::Store::Mode::create);
    bool interrupted = false;
    const auto last_but_one = placed[static_cast<std::size_t>(*stopped) - 2].question.id;
    ScriptedCrew crew(
        [&](const auto& attempt) -> workers::PoolEvent {
            if (attempt.case_id == last_but_one && !std::exchange(interrupted, true)) return workers::Interrupted{};
            return nearly_equal(attempt);
        },
        2);
    Judge disturbed = judge();
    EXPECT_EQ(run(crew, {}, {}, &disturbed), Ending::converged);
    EXPECT_TRUE(interrupted);
    EXPECT_EQ(store.campaigns().at(0).stopped_at, stopped);
}

TEST_F(SchedulerLoop, StoresWhatComputedAnAttempt) {
    ScriptedCrew crew([](const auto& attempt) { return completed(attempt); });
    EXPECT_EQ(run(crew), Ending::finished);
    EXPECT_EQ(store.attempts(placed[0].question.id).at(0).computer, *crew.computer);
}

TEST_F(SchedulerLoop, WhatEndsAWorkerFromOutsideCostsNoTry) {
    int ended = 0;
    std::vector<std::string> notes, forgotten;
    Watchers watchers;
    watchers.note = [&](const std::string& text) { notes.push_back(text); };
    watchers.forget_checkpoint = [&](const campaign::CaseId& id) { forgotten.push_back(id); };
    ScriptedCrew crew([&](const auto& attempt) -> workers::PoolEvent {
        if (++ended > 4) return completed(attempt);
        workers::Lost lost;
        lost.running = attempt;
        lost.reason = "worker ended by signal 15 (Terminated)";
        lost.from_outside = lost.spoils_checkpoint = true;
        return lost;
    });
    EXPECT_EQ(run(crew, {.attempts = 1}, std::move(watchers)), Ending::finished);
    EXPECT_EQ(stored("completed"), 10);
    const auto log = store.attempts(placed[0].question.id);
    ASSERT_EQ(log.size(), 5U);
    EXPECT_EQ(log[0].outcome, Outcome::abandoned);
    EXPECT_EQ(log[0].message, "worker ended by signal 15 (Terminated)");
    EXPECT_EQ(notes.size(), 4U);
    EXPECT_TRUE(forgotten.empty()) << "its checkpoint is as good as before";
}

TEST_F(SchedulerLoop, ACheckpointThatACaseCrashedOnIsForgotten) {
    int crashes = 0;
    std::vector<std::string> forgotten;
    Watchers watchers;
    watchers.forget_checkpoint = [&](const campaign::CaseId& id) { forgotten.push_back(id); };
    ScriptedCrew crew([&](const auto& attempt) -> workers::PoolEvent {
        if (++crashes > 1) return completed(attempt);
        workers::Lost lost;
        lost.running = attempt;
        lost.spoils_checkpoint = true;
        return lost;
    });
    EXPECT_EQ(run(crew, {}, std::move(watchers)), Ending::finished);
    EXPECT_EQ(forgotten, std::vector<std::string>{placed[0].question.id});
}

TEST_F(SchedulerLoop, ACaseThatOnlyComesBackEndsWithAMessage) {
    ScriptedCrew crew([&](const auto& attempt) -> workers::PoolEvent {
        if (attempt.case_id != placed[3].question.id) return completed(attempt);
        return workers::GivenBack{attempt, "for no reason", 0, false};
    });
    EXPECT_EQ(run(crew), Ending::finished);
    EXPECT_EQ(stored("completed"), 9);
    const auto log = store.attempts(placed[3].question.id);
    EXPECT_EQ(log.size(), static_cast<std::size_t>(Rules{}.give_backs));
    EXPECT_EQ(log.back().outcome, Outcome::abandoned);
    EXPECT_NE(log.back().message.find("for no reason; given back too often"), std::string::npos) << log.back().message;
}

TEST_F(SchedulerLoop, ACrashThatAWorkerTellsOfIsTriedAgain) {
    int crashes = 0;
    ScriptedCrew crew([&](const auto& attempt) -> workers::PoolEvent {
        auto finished = completed(attempt);
        if (++crashes <= 2) finished.result.outcome = Outcome::crashed;
        return finished;
    });
    EXPECT_EQ(run(crew), Ending::finished);
    EXPECT_EQ(stored("completed"), 10);
    EXPECT_EQ(store.attempts(placed[0].question.id).size(), 3U);
}

TEST_F(SchedulerLoop, AFullDiskEndsTheRunAndIsNoFailureOfTheCase) {
    ScriptedCrew full([&](const auto& attempt) -> workers::PoolEvent {
        if (attempt.case_id != placed[3].question.id) return completed(attempt);
        return workers::GivenBack{attempt, "folder 'x': no space left", 0, false, true};
    });
    try {
        run(full);
        ADD_FAILURE() << "a broken world ends the run";
    } catch (const SystemError& broken) {
        EXPECT_EQ(std::string(broken.what()), "folder 'x': no space left");
    }
    const auto log = store.attempts(placed[3].question.id);
    ASSERT_EQ(log.size(), 1U);
    EXPECT_EQ(log[0].outcome, Outcome::abandoned);
    EXPECT_EQ(log[0].message, "folder 'x': no space left");
    EXPECT_EQ(store.result(placed[0].question.id)->outcome, Outcome::completed) << "what was computed before is stored";
    ScriptedCrew second([](const auto& attempt) { return completed(attempt); });
    EXPECT_EQ(run(second), Ending::finished);
    EXPECT_EQ(stored("completed"), 10);
}

TEST_F(SchedulerLoop, GivenBackCasesAreAbandonedAndAskedAgain) {
    bool interrupted = false;
    ScriptedCrew crew(
        [&](const auto& attempt) -> workers::PoolEvent {
            if (attempt.case_id == placed[2].question.id) return workers::GivenBack{attempt, "", 0, true};
            if (attempt.case_id == placed[1].question.id && !interrupted) {
                interrupted = true;
                return workers::Interrupted{};
            }
            return completed(attempt);
        },
        3);
    run(crew);
    EXPECT_EQ(stored("abandoned"), 1);
    ScriptedCrew second([](const auto& attempt) { return completed(attempt); });
    EXPECT_EQ(run(second), Ending::finished);
}

TEST_F(SchedulerLoop, StopsAfterTooManyFailures) {
    ScriptedCrew crew([](const auto& attempt) {
        campaign::CaseResult result;
        result.attempt = attempt;
        result.outcome = Outcome::unstable;
        result.message = "overlap";
        return workers::Finished{result, false};
    });
    Rules rules;
    rules.stop_after_failures = 2;
    EXPECT_EQ(run(crew, rules), Ending::too_many_failures);
    EXPECT_EQ(crew.started.size(), 2U);
    EXPECT_EQ(stored("unstable"), 2);
}

TEST_F(SchedulerLoop, CheckpointsAreForgottenOnlyAfterTheResultIsOnDisk) {
    std::vector<std::string> forgotten;
    Watchers watchers;
    watchers.forget_checkpoint = [&](const campaign::CaseId& id) {
        EXPECT_EQ(store::Store(folder / "loop.db", store::Store::Mode::read).result(id)->outcome, Outcome::completed);
        forgotten.push_back(id);
    };
    ScriptedCrew crew([&](const auto& attempt) {
        auto finished = completed(attempt);
        finished.checkpointed = attempt.case_id == placed[4].question.id;
        return finished;
    });
    run(crew, {}, std::move(watchers));
    EXPECT_EQ(forgotten, std::vector<std::string>{placed[4].question.id});
}

TEST_F(SchedulerLoop, ARequestOfASystemIsNoInterruptOfTheUser) {
    ScriptedCrew crew([asked = false](const auto& attempt) mutable -> workers::PoolEvent {
        if (!std::exchange(asked, true)) return workers::Interrupted{false, true};
        return completed(attempt);
    });
    EXPECT_EQ(run(crew), Ending::asked_to_end);
    EXPECT_EQ(stored("completed"), 1);
}

}  // namespace grainsweep::tests::schedule_scheduler_test
