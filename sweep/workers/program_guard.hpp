// A process of its own that outlives the one that starts programs: when that one ends, however it ends, what it started
// is asked to end (TERM) and killed after a grace. It finds the present process group by number, and what left the
// group by a variable of its environment, so that nothing survives a worker that was killed.
#pragma once

#include <sys/types.h>

#include <string>

namespace grainsweep::workers {

/// Seconds between TERM and KILL.
inline constexpr double program_grace = 2;

class ProgramGuard {
public:
    /// Forks the guard: make it before any thread. From then on orphans of programs become children of this process.
    ProgramGuard();
    ProgramGuard(const ProgramGuard&) = delete;
    ProgramGuard& operator=(const ProgramGuard&) = delete;
    ~ProgramGuard();

    /// The process group that now runs; 0: none.
    void watch(pid_t group);
    /// "NAME=value", to stand in the environment of every program.
    [[nodiscard]] const std::string& mark() const { return mark_; }

private:
    struct Shared;
    Shared* shared_ = nullptr;
    int pipe_ = -1;  ///< closed by the end of this process
    std::string mark_;
};

}  // namespace grainsweep::workers
