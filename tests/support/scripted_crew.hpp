// A crew without processes and without a clock: a script answers its cases, one after another.
#pragma once

#include "sweep/workers/worker_pool.hpp"

#include <chrono>
#include <cstddef>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace grainsweep::tests {

/// Answers its oldest case with what the script says of it; takes `room` cases at once.
class ScriptedCrew final : public workers::WorkerPool {
public:
    using Script = std::function<workers::PoolEvent(const campaign::Attempt&)>;
    explicit ScriptedCrew(Script script, std::size_t room = 1) : script_(std::move(script)), room_(room) {}

    void expect(std::size_t cases) override { expected = cases; }
    [[nodiscard]] std::optional<workers::Place> place_for(double) override {
        if (retired || waiting.size() >= room_) return std::nullopt;
        return workers::Place{0, computer};
    }
    void share_cores(std::size_t cases, const SecondsLeft& left) override {
        shared.emplace_back(cases, waiting.empty() ? 0 : left(waiting.front()));
    }
    void give(const workers::Place&, const campaign::Attempt& attempt, const campaign::Case&) override {
        started.push_back(attempt);
        waiting.push_back(attempt);
    }
    [[nodiscard]] std::optional<workers::PoolEvent> wait(std::chrono::milliseconds) override {
        idle();
        if (waiting.empty()) return std::nullopt;
        auto event = script_(waiting.front());
        // An interrupt answers no case, nor does a heartbeat.
        if (!std::holds_alternative<workers::Interrupted>(event) && !std::holds_alternative<workers::Heartbeat>(event))
            waiting.pop_front();
        return event;
    }
    void retire() override { retired = true; }
    void dismiss() override { dismissed = true; }

    std::vector<campaign::Attempt> started;
    std::deque<campaign::Attempt> waiting;               ///< given and not answered
    std::function<void()> idle = [] {};                  ///< before every answer
    std::vector<std::pair<std::size_t, double>> shared;  ///< cases that waited; seconds left of the first that ran
    std::size_t expected = 0;
    std::shared_ptr<const campaign::Computer> computer =
        std::make_shared<const campaign::Computer>(campaign::Computer{"1", "c", "b", "avx2", "p", "its host"});
    bool retired = false, dismissed = false;

private:
    Script script_;
    std::size_t room_;
};

}  // namespace grainsweep::tests
