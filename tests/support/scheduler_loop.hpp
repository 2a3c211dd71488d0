// The loop of ten cases of the rehearsal scene with a scripted crew, into a database of its own.
#pragma once

#include "solver/scenes/scene.hpp"
#include "sweep/campaign/campaign.hpp"
#include "sweep/schedule/judge.hpp"
#include "sweep/schedule/scheduler.hpp"
#include "tests/support/process.hpp"
#include "tests/support/scripted_crew.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace grainsweep::tests {

using schedule::Ending, schedule::Rules, schedule::Watchers, schedule::Judge, schedule::Walltime;

inline workers::Finished completed(const campaign::Attempt& attempt, double y = 1) {
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
        std::vector<schedule::History> histories;
        for (const auto& state : states) histories.push_back({state.attempts, state.failures, state.outcome});
        const auto question = [this](std::uint32_t i) { return placed[i].question; };
        schedule::Plan plan({question, histories, predicted(), {}, {}}, rules);
        store::Recorder recorder(store);
        schedule::Scheduler scheduler("loop", plan, crew, recorder, judge, std::move(watchers), std::move(walltime));
        return scheduler.run();
    }

    [[nodiscard]] std::vector<double> predicted() const {
        return seconds.empty() ? std::vector<double>(placed.size(), 1.0) : seconds;
    }

    std::int64_t stored(const std::string& outcome) {
        const auto table = store.query("SELECT count(*) FROM loop WHERE outcome = '" + outcome + "'");
        return std::get<std::int64_t>(table.rows.at(0).at(0));
    }

    tests::Folder folder;
    campaign::Campaign campaign;
    std::vector<campaign::PlacedCase> placed;
    std::vector<double> seconds;  ///< predicted; empty: 1 of each
    store::Store store;
};

}  // namespace grainsweep::tests
