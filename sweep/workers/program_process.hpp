// A program's process: started without a shell, head of a group of its own, with limits, and ended with all of its
// children. The only file of the programs' side that starts one.
#pragma once

#include "sweep/workers/program_guard.hpp"

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::workers {

struct ProgramStart {
    std::vector<std::string> argv;         ///< argv[0]: as found by find_program
    std::vector<std::string> environment;  ///< "NAME=value", over those of this process
    int folder = -1;                       ///< descriptor of its working folder
    int in = -1, out = -1, err = -1;       ///< descriptors of its standard streams; -1: /dev/null
    std::int64_t memory = 0;               ///< RLIMIT_AS, bytes; 0: as here
    std::int64_t file = 0;                 ///< RLIMIT_FSIZE, bytes; 0: as here
};

/// How a program ended and what it took, its children that it waited for included.
struct ProgramEnd {
    int status = 0;  ///< as of waitpid(2)
    double cpu_seconds = 0;
    /// Bytes resident at once, of the program or one of its children. Not below what this process itself took: the
    /// kernel counts from the fork.
    double peak_memory = 0;
};

/// The path of a program: as it is where the word has a slash, else by the search path. Empty: there is none that may
/// be executed.
[[nodiscard]] std::string find_program(const std::string& word);

class ProgramProcess {
public:
    /// Throws std::runtime_error with a sentence where it cannot be started; BrokenWorld where this machine has no
    /// process or descriptor left.
    ProgramProcess(const ProgramStart& start, ProgramGuard& guard);
    ProgramProcess(const ProgramProcess&) = delete;
    ProgramProcess& operator=(const ProgramProcess&) = delete;
    /// Ends it and all of its children.
    ~ProgramProcess();

    [[nodiscard]] pid_t id() const { return id_; }
    /// A descriptor that can be read from once it has ended.
    [[nodiscard]] int ended_descriptor() const { return ended_; }
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
    int ended_ = -1;
    bool reaped_ = false;
    ProgramEnd result_;
};

/// "ended with exit code 2", "ended by signal 11 (Segmentation fault)".
[[nodiscard]] std::string end_in_words(int status);

}  // namespace grainsweep::workers
