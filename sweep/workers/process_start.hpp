// Start of other programs without a shell, each in a process group of its own, and the interpretation of their exit
// status.
#pragma once

#include <sys/types.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace grainsweep::workers {

struct ProcessStart {
    std::vector<std::string> argv;              ///< argv[0]: a path, as found by find_program
    std::vector<std::string> environment = {};  ///< "NAME=value"; these override the variables of this process
    std::array<int, 3> streams = {-1, -1, -1};  ///< descriptors of its standard streams; -1: /dev/null
    int folder = -1;                            ///< descriptor of its working folder; -1: that of this process
    std::optional<std::int64_t> memory = {};    ///< RLIMIT_AS, bytes; empty: as this process
    std::optional<std::int64_t> file = {};      ///< RLIMIT_FSIZE, bytes; empty: as this process
    /// The program is not grainsweep. It inherits no other descriptor and no blocked or ignored signal, writes no core
    /// file, and is killed when this process ends. The calling thread waits until the program runs or has failed to
    /// start. It does not wait for grainsweep's own processes, because a dead file server could block it for ever. A
    /// process that cannot be executed writes the reason to its standard error and ends.
    bool stranger = false;
};

/// Starts a process and returns its id. Returns -1 and sets `error` if the system has no process left, or if a
/// stranger's program cannot be executed.
[[nodiscard]] pid_t start_process(const ProcessStart& start, std::error_code& error);

/// Returns the path of a program: the word itself if it has a slash, else the result of the search path. Empty: no
/// executable file is found.
[[nodiscard]] std::string find_program(const std::string& word);

// Interpretation of a status of waitpid(2).
/// Returns the signal that ended the process, also if a launcher or a shell reports the signal as an exit code; 0:
/// none.
[[nodiscard]] int ending_signal(int status);
/// Returns whether the process was ended from outside: by a signal that requests an end, or by Slurm. Slurm writes to
/// the log that it ends a step because of a time limit, a pre-emption or a failed node.
[[nodiscard]] bool ended_from_outside(int status, std::string_view log);
/// Returns a text such as "worker ended by signal 9 (Killed)".
[[nodiscard]] std::string describe_end(std::string_view what, int status);

}  // namespace grainsweep::workers
