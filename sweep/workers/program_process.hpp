// A program's process: ended with all of its children.
#pragma once

#include "sweep/files/descriptor.hpp"
#include "sweep/workers/process_start.hpp"
#include "sweep/workers/program_guard.hpp"

#include <sys/types.h>

#include <functional>

namespace grainsweep::workers {

/// How a program ended and what it took, its children that it waited for included.
struct ProgramEnd {
    int status = 0;  ///< as of waitpid(2)
    double cpu_seconds = 0;
    /// Bytes resident at once, of the program or one of its children. Not below what this process itself took: the
    /// kernel counts from the fork.
    double peak_memory = 0;
};

class ProgramProcess {
public:
    /// Throws std::runtime_error with a sentence where it cannot be started; BrokenWorld where this machine has no
    /// process or descriptor left.
    ProgramProcess(ProcessStart start, ProgramGuard& guard);
    ProgramProcess(const ProgramProcess&) = delete;
    ProgramProcess& operator=(const ProgramProcess&) = delete;
    /// Ends it and all of its children.
    ~ProgramProcess();

    [[nodiscard]] pid_t id() const { return id_; }
    /// Waits for its end so long; whether it has ended.
    [[nodiscard]] bool wait(double seconds);
    /// TERM to its group, KILL after a grace or when `hurry` says so; whatever survived goes with it.
    void end(const std::function<bool()>& hurry = {});
    /// After its end.
    [[nodiscard]] const ProgramEnd& result() const { return result_; }
    /// So far, of a running one.
    [[nodiscard]] double cpu_seconds() const;

private:
    void reap(int options);
    void end_stragglers();

    ProgramGuard& guard_;
    pid_t id_ = -1;
    files::Descriptor ended_;  ///< can be read from once it has ended
    bool reaped_ = false;
    ProgramEnd result_;
};

}  // namespace grainsweep::workers
