// Guard: a process that outlives the process that starts programs. When that process ends in any way, the guard sends
// TERM to its programs, and KILL after a grace. It finds the running process group by its number, and processes that
// left the group by a variable in their environment. So no program survives a worker that was killed.
#pragma once

#include <sys/types.h>

#include <string>

namespace grainsweep::workers {

/// Seconds between TERM and KILL.
inline constexpr double program_grace = 2;

class ProgramGuard {
public:
    /// Forks the guard; call it before any other thread starts. From then on orphans of programs become children of
    /// this process.
    ProgramGuard();
    ProgramGuard(const ProgramGuard&) = delete;
    ProgramGuard& operator=(const ProgramGuard&) = delete;
    ~ProgramGuard();

    /// Sets the process group that runs now; 0: none.
    void watch(pid_t group);
    /// Returns "NAME=value", which the environment of every program must contain.
    [[nodiscard]] const std::string& mark() const { return mark_; }

private:
    struct Shared;
    Shared* shared_ = nullptr;
    int pipe_ = -1;  ///< the end of this process closes it
    std::string mark_;
};

}  // namespace grainsweep::workers
