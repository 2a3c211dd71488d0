// The loop with a scripted crew: no process, no clock.
#include "sweep/schedule/scheduler.hpp"

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/campaign.hpp"
#include "sweep/schedule/judge.hpp"
#include "tests/support/process.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <numeric>
#include <utility>
#include <vector>

using namespace grainsweep;
using namespace grainsweep::schedule;
using campaign::Outcome;

namespace {

/// Answers with whatever the script says; y = number of cases handed out so far.
class ScriptedCrew final : public workers::Crew {
public:
    using Script = std::function<workers::PoolEvent(const campaign::Attempt&)>;
    explicit ScriptedCrew(Script script, std::size_t room = 1) : script_(std::move(script)), room_(room) {}

    void expect(std::size_t cases) override { expected = cases; }
    [[nodiscard]] std::optional<workers::Place> place_for(double) override {
        if (retired || waiting_.size() >= room_) return std::nullopt;
        return workers::Place{0, computer};
    }
    void share_cores(std::size_t waiting, const SecondsLeft& left) override {
        shared.emplace_back(waiting, waiting_.empty() ? 0 : left(waiting_.front()));
    }
    void give(const workers::Place&, const campaign::Attempt& attempt, const campaign::Case&) override {
        started.push_back(attempt);
        waiting_.push_back(attempt);
    }
    [[nodiscard]] std::optional<workers::PoolEvent> wait(std::chrono::milliseconds) override {
        if (waiting_.empty()) return std::nullopt;
        auto event = script_(waiting_.front());
        // An interrupt answers no case, nor does a heartbeat.
        if (!std::holds_alternative<workers::Interrupted>(event) && !std::holds_alternative<workers::Heartbeat>(event))
            waiting_.pop_front();
        return event;
    }
    void retire() override { retired = true; }
    void dismiss() override { dismissed = true; }

    std::vector<campaign::Attempt> started;
    std::vector<std::pair<std::size_t, double>> shared;  ///< cases that waited; seconds left of the first that ran
    std::size_t expected = 0;
    std::shared_ptr<const campaign::Computer> computer =
        std::make_shared<const campaign::Computer>(campaign::Computer{"1", "c", "b", "avx2", "p", "its host"});
    bool retired = false, dismissed = false;

private:
    Script script_;
    std::size_t room_;
    std::deque<campaign::Attempt> waiting_;
};

workers::Finished completed(const campaign::Attempt& attempt, double y = 1) {
    campaign::CaseResult result;
    result.attempt = attempt;
    result.observations.scalars["y"] = y;
    return {result, false};
}

class SchedulerLoop : public testing::Test {
protected:
    SchedulerLoop() : store(folder / "loop.db", store::Store::Mode::create) {
        campaign.name = "loop";
        campaign.space.scene = find_scene("rehearsal");
        campaign.space.factors = {{"x1", campaign::Between{0, 1}}};
        campaign.design = "random";
        for (int point = 0; point < 10; ++point) {
            Inputs inputs = campaign.scene().defaults();
            inputs["x1"] = 0.1 * point;
            placed.push_back({campaign::make_case(campaign.scene(), inputs, 1), point, 0, 0});
        }
    }

    Ending run(ScriptedCrew& crew, Rules rules = {}, Watchers watchers = {}, Judge* judge = nullptr,
               std::size_t at_once = 1000, Walltime walltime = {}) {
        const auto states = store.enrol(campaign, placed, {}, at_once);
        std::vector<History> histories;
        for (const auto& state : states) histories.push_back({state.attempts, state.failures, state.outcome});
        const auto question = [this](std::uint32_t i) { return placed[i].question; };
        Plan plan({question, histories, predicted(), {}, {}}, rules);
        store::Recorder recorder(store);
        Scheduler scheduler("loop", plan, crew, recorder, judge, std::move(watchers), std::move(walltime));
        return scheduler.run();
    }

    [[nodiscard]] std::vector<double> predicted() const {
        return seconds.empty() ? std::vector<double>(placed.size(), 1.0) : seconds;
    }

    std::int64_t stored(const std::string& outcome) {
        const auto table = store.query("SELECT count(*) FROM loop WHERE outcome = '" + outcome + "'");
        return std::get<std::int64_t>(table.rows.at(0).at(0));
    }

    test::Folder folder;
    campaign::Campaign campaign;
    std::vector<campaign::PlacedCase> placed;
    std::vector<double> seconds;  ///< predicted; empty: 1 of each
    store::Store store;
};

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
    Judge undisturbed = judge();
    ScriptedCrew calm([](const auto& attempt) { return completed(attempt); }, 2);
    EXPECT_EQ(run(calm, {}, {}, &undisturbed), Ending::converged);
    const auto stopped = store.campaigns().at(0).stopped_at;
    ASSERT_TRUE(stopped && *stopped < 10);

    store = store::Store(folder / "other.db", store::Store::Mode::create);
    bool interrupted = false;
    const auto last_but_one = placed[static_cast<std::size_t>(*stopped) - 2].question.id;
    ScriptedCrew crew(
        [&](const auto& attempt) -> workers::PoolEvent {
            if (attempt.case_id == last_but_one && !std::exchange(interrupted, true)) return workers::Interrupted{};
            return completed(attempt);
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
    } catch (const store::BrokenWorld& broken) {
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

/// A crew whose cases take what is predicted, and the time that is left of `whole` seconds.
class TimedCrew {
public:
    TimedCrew(std::vector<double> seconds, double whole, bool cases_go_on)
        : seconds_(std::move(seconds)), left_(whole), whole_(whole), cases_go_on_(cases_go_on) {}
    [[nodiscard]] ScriptedCrew crew(const std::vector<campaign::PlacedCase>& placed) {
        return ScriptedCrew([&](const auto& attempt) -> workers::PoolEvent {
            const auto at = std::ranges::find(placed, attempt.case_id, [](const auto& one) { return one.question.id; });
            const double takes = seconds_.at(static_cast<std::size_t>(at - placed.begin()));
            const double spent = std::min(takes, left_);
            left_ -= spent;
            if (spent < takes) return workers::GivenBack{attempt, "given back before it was finished", spent, true};
            return completed(attempt);
        });
    }
    [[nodiscard]] Walltime walltime() {
        return {[this] { return left_; }, whole_, cases_go_on_, 0.5};
    }

private:
    std::vector<double> seconds_;
    double left_, whole_;
    bool cases_go_on_;
};

TEST_F(SchedulerLoop, NothingIsBegunThatCannotFinishInTime) {
    seconds = {1, 1, 1, 8, 1, 1, 1, 1, 1, 1};
    TimedCrew timed(seconds, 7, false);
    auto crew = timed.crew(placed);
    EXPECT_EQ(run(crew, {}, {}, nullptr, 1000, timed.walltime()), Ending::out_of_time);
    EXPECT_EQ(stored("completed"), 7) << "what fits is computed, what does not is left out";
    EXPECT_EQ(stored("abandoned"), 0);
    TimedCrew next(seconds, 10, false);
    auto again = next.crew(placed);
    EXPECT_EQ(run(again, {}, {}, nullptr, 1000, next.walltime()), Ending::finished);
}

TEST_F(SchedulerLoop, WhatFitsIntoNoRunIsSaid) {
    seconds = {1, 1, 1, 12, 1, 1, 1, 1, 1, 1};
    TimedCrew timed(seconds, 10, false);
    auto crew = timed.crew(placed);
    EXPECT_EQ(run(crew, {}, {}, nullptr, 1000, timed.walltime()), Ending::too_long);
    EXPECT_EQ(stored("completed"), 9);
}

TEST_F(SchedulerLoop, ACaseThatGoesOnLaterIsBegunWhereAPartOfItFits) {
    seconds = {1, 1, 1, 12, 1, 1, 1, 1, 1, 1};
    TimedCrew timed(seconds, 10, true);
    auto crew = timed.crew(placed);
    EXPECT_EQ(run(crew, {}, {}, nullptr, 1000, timed.walltime()), Ending::out_of_time);
    EXPECT_TRUE(crew.retired);
    EXPECT_EQ(store.attempts(placed[3].question.id).size(), 1U) << "it is given back unfinished";
}

TEST_F(SchedulerLoop, NoPartIsBegunForLessThanItsSavingTakes) {
    seconds = std::vector<double>(10, 1);
    TimedCrew timed(seconds, 3.4, true);
    auto crew = timed.crew(placed);
    EXPECT_EQ(run(crew, {}, {}, nullptr, 1000, timed.walltime()), Ending::out_of_time);
    EXPECT_EQ(stored("completed"), 3);
    EXPECT_EQ(crew.started.size(), 3U);
}

TEST_F(SchedulerLoop, ARequestOfASystemIsNoInterruptOfTheUser) {
    ScriptedCrew crew([asked = false](const auto& attempt) mutable -> workers::PoolEvent {
        if (!std::exchange(asked, true)) return workers::Interrupted{false, true};
        return completed(attempt);
    });
    EXPECT_EQ(run(crew), Ending::asked_to_end);
    EXPECT_EQ(stored("completed"), 1);
}

}  // namespace
