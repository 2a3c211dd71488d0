// The main program's side of the protocol: the messages that a worker may send, and the cases that it has. The state
// diagram is in message.hpp. Pure: uses no process, pipe or clock; `now` is seconds of any clock that never goes back.
#pragma once

#include "solver/scenes/values.hpp"
#include "sweep/campaign/case.hpp"
#include "sweep/workers/message.hpp"
#include "sweep/workers/worker_pool.hpp"

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace grainsweep::workers {

/// Expected program of a worker, and its observables.
struct Expected {
    campaign::Computer program;            ///< version, commit and build are compared, the machine is not
    std::vector<ObservableSpec> measured;  ///< observables of the scene
};

/// Time limits, in seconds.
struct TimeLimits {
    std::optional<double> wall;          ///< of one case, from its beginning
    std::optional<double> start = 300;   ///< until a worker is ready
    std::optional<double> silence = 60;  ///< without a message, while one is expected
};

class WorkerState {
public:
    enum class Phase { starting, serving, leaving, dismissed };

    /// Line before `ready` that is no message; it comes from the launcher.
    struct Banner {
        std::string line;
    };
    /// Violation of the protocol; the worker must be dismissed.
    struct Complaint {
        std::string why;
    };
    struct Nothing {};
    using Meaning = std::variant<Nothing, Finished, Heartbeat, GivenBack, Banner, Complaint>;

    WorkerState(const Expected& expected, double now) : expected_(&expected), launched_(now), received_at_(now) {}

    /// Interprets a line of the worker's standard output.
    [[nodiscard]] Meaning receive(std::string_view line, double now);
    /// Records that a case is sent to the worker. Only in the state `serving`.
    void give(const campaign::Attempt& attempt, double now);
    /// Records that `stop` is sent to the worker.
    void stop();
    /// Records that the worker is being ended; its further output is ignored.
    void dismiss() { phase_ = Phase::dismissed; }

    enum class Overdue { nothing, start, silence, answer };
    [[nodiscard]] Overdue overdue(const TimeLimits& limits, double now) const;
    /// Returns the seconds since its last message, counted while a message is expected.
    [[nodiscard]] double silence(double now) const;

    [[nodiscard]] Phase phase() const { return phase_; }
    [[nodiscard]] bool was_ready() const { return computer_ != nullptr; }
    [[nodiscard]] bool has_begun_any() const { return has_begun_any_; }
    /// Returns the number of its cases that are neither answered nor given back.
    [[nodiscard]] std::size_t cases() const { return waiting_.size() + (running_ ? 1 : 0); }
    /// Returns the case that it has begun, if any.
    [[nodiscard]] std::optional<campaign::Attempt> running() const;
    [[nodiscard]] bool resumed() const { return running_ && running_->resumed; }
    [[nodiscard]] double running_seconds(double now) const { return running_ ? now - running_->began : 0; }
    /// Returns its cases that are not begun.
    [[nodiscard]] std::vector<campaign::Attempt> waiting() const { return {waiting_.begin(), waiting_.end()}; }
    [[nodiscard]] const std::shared_ptr<const campaign::Computer>& computer() const { return computer_; }
    /// Returns its output before it was ready, shortened.
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
    double second_ = 0;  ///< start of the second in which heartbeats are counted
    int heartbeats_ = 0;
    std::string banner_;
    std::size_t banner_bytes_ = 0;
};

/// Returns the text cut to at most `bytes`, between characters.
[[nodiscard]] std::string shortened(std::string_view text, std::size_t bytes);

}  // namespace grainsweep::workers
