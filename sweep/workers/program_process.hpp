// Process of a program, which is ended together with all its children.
#pragma once

#include "sweep/files/descriptor.hpp"
#include "sweep/workers/process_start.hpp"
#include "sweep/workers/program_guard.hpp"

#include <sys/types.h>

#include <functional>

namespace grainsweep::workers {

/// End of a program and the resources it used, including the children that it waited for.
struct ProgramEnd {
    int status = 0;  ///< as of waitpid(2)
    double cpu_seconds = 0;
    /// Largest resident memory in bytes, of the program or one of its children. Never below the memory of this process,
    /// because the kernel counts from the fork.
    double peak_memory = 0;
};

class ProgramProcess {
public:
    /// Starts the program. Throws std::runtime_error with a sentence if it cannot be started, SystemError if this
    /// machine has no process or descriptor left.
    ProgramProcess(ProcessStart start, ProgramGuard& guard);
    ProgramProcess(const ProgramProcess&) = delete;
    ProgramProcess& operator=(const ProgramProcess&) = delete;
    /// Ends the program and all its children.
    ~ProgramProcess();

    [[nodiscard]] pid_t id() const { return id_; }
    /// Waits for its end, for at most this time. Returns whether it has ended.
    [[nodiscard]] bool wait(double seconds);
    /// Sends TERM to its group, then KILL after a grace or when `hurry` returns true. Ends processes that left the
    /// group, too.
    void end(const std::function<bool()>& hurry = {});
    /// Returns the result; valid after its end.
    [[nodiscard]] const ProgramEnd& result() const { return result_; }
    /// Returns the processor seconds so far of a running program.
    [[nodiscard]] double cpu_seconds() const;

private:
    void reap(int options);
    void end_stragglers();

    ProgramGuard& guard_;
    pid_t id_ = -1;
    files::Descriptor ended_;  ///< becomes readable once the process has ended
    bool reaped_ = false;
    ProgramEnd result_;
};

}  // namespace grainsweep::workers
