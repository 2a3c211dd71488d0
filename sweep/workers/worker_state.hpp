// The main program's side of the protocol: what a worker may write when, and what it has in hands. The state diagram is
// in message.hpp. Pure: sees no process, pipe or clock; `now` is seconds on any clock that only grows.
#pragma once

#include "solver/scenes/values.hpp"
#include "sweep/campaign/case.hpp"
#include "sweep/workers/crew.hpp"
#include "sweep/workers/message.hpp"

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace grainsweep::workers {

/// What a worker must be, and may measure.
struct Expected {
    campaign::Computer program;            ///< version, commit and build count, where it runs does not
    std::vector<ObservableSpec> measured;  ///< observables of the scene
};

/// Seconds.
struct TimeLimits {
    std::optional<double> wall;          ///< of one case, from when it is begun
    std::optional<double> start = 300;   ///< until a worker is ready
    std::optional<double> silence = 60;  ///< of a worker that owes something
};

class WorkerState {
public:
    enum class Phase { starting, serving, leaving, dismissed };

    /// A line before `ready` that is no message: the launcher's, which may greet.
    struct Banner {
        std::string line;
    };
    /// What is against the protocol; the worker must be dismissed.
    struct Complaint {
        std::string why;
    };
    struct Nothing {};
    using Meaning = std::variant<Nothing, Finished, Heartbeat, GivenBack, Banner, Complaint>;

    WorkerState(const Expected& expected, double now) : expected_(&expected), launched_(now), received_at_(now) {}

    /// A line of its standard output.
    [[nodiscard]] Meaning receive(std::string_view line, double now);
    /// A case is written to it. Only while it serves.
    void give(const campaign::Attempt& attempt, double now);
    /// `stop` is written to it.
    void stop();
    /// It is being ended; nothing it writes counts from now on.
    void dismiss() { phase_ = Phase::dismissed; }

    enum class Overdue { nothing, start, silence, answer };
    [[nodiscard]] Overdue overdue(const TimeLimits& limits, double now) const;
    /// Seconds since it last wrote while something was expected of it.
    [[nodiscard]] double silence(double now) const;

    [[nodiscard]] Phase phase() const { return phase_; }
    [[nodiscard]] bool was_ready() const { return computer_ != nullptr; }
    [[nodiscard]] bool has_begun_any() const { return has_begun_any_; }
    /// What it was given and has not answered or given back.
    [[nodiscard]] std::size_t cases() const { return waiting_.size() + (running_ ? 1 : 0); }
    /// Of those the one it has begun.
    [[nodiscard]] std::optional<campaign::Attempt> running() const;
    [[nodiscard]] bool resumed() const { return running_ && running_->resumed; }
    [[nodiscard]] double running_seconds(double now) const { return running_ ? now - running_->began : 0; }
    /// And the others.
    [[nodiscard]] std::vector<campaign::Attempt> waiting() const { return {waiting_.begin(), waiting_.end()}; }
    [[nodiscard]] const std::shared_ptr<const campaign::Computer>& computer() const { return computer_; }
    /// What it wrote before it was ready, shortened.
    [[nodiscard]] const std::string& banner() const { return banner_; }
    [[nodiscard]] double launched() const { return launched_; }

private:
    [[nodiscard]] Meaning receive_starting(std::string_view line, double now);
    [[nodiscard]] Meaning understand(Begun& begun, double now);
    [[nodiscard]] Meaning understand(const Alive& alive, double now);
    [[nodiscard]] Meaning understand(Done& done);
    [[nodiscard]] Meaning understand(GiveBack& back, double now);
    [[nodiscard]] bool is_running(const campaign::Attempt& attempt) const;

    const Expected* expected_;
    Phase phase_ = Phase::starting;
    std::shared_ptr<const campaign::Computer> computer_;
    struct Running {
        campaign::Attempt attempt;
        bool resumed = false;  ///< from a checkpoint
        double began = 0;
    };
    std::optional<Running> running_;
    std::deque<campaign::Attempt> waiting_;  ///< in the order in which it will begin them
    bool has_begun_any_ = false;
    double launched_ = 0, received_at_ = 0;
    double second_ = 0;  ///< heartbeats are counted from here
    int heartbeats_ = 0;
    std::string banner_;
    std::size_t banner_bytes_ = 0;
};

/// Not longer than `bytes`, cut between characters.
[[nodiscard]] std::string shortened(std::string_view text, std::size_t bytes);

}  // namespace grainsweep::workers
