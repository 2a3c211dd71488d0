// Requests to end a command that runs cases: SIGINT (Ctrl-C), SIGTERM and SIGUSR1, which systems send before a job
// ends.
//
// While a pool computes, it attends to them. At all other times (reading, between two waves, at the end) nothing runs
// that could be lost, and the process ends at once with its documented exit code: 130 after SIGINT, else 75.
#pragma once

#include <optional>

namespace grainsweep::workers {

/// Answers these signals from now on; repeating it has no effect. Call it before the first case.
void answer_end_requests();

/// Returns the exit code that a request asks for, if a pool has received one. A command with several parts begins no
/// further part then.
[[nodiscard]] std::optional<int> requested_end();

/// Attention of a pool to requests.
class EndRequests {
public:
    EndRequests();
    EndRequests(const EndRequests&) = delete;
    EndRequests& operator=(const EndRequests&) = delete;
    ~EndRequests();

    /// Returns a descriptor that is readable when there is a request.
    [[nodiscard]] int descriptor() const;
    /// Returns the signal of the next request; empty: none.
    [[nodiscard]] std::optional<int> next();
};

}  // namespace grainsweep::workers
