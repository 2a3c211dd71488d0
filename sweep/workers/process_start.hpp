// How this program starts others, without a shell, each the head of a process group of its own; and what their ends
// say.
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
    std::vector<std::string> environment = {};  ///< "NAME=value", over those of this process
    std::array<int, 3> streams = {-1, -1, -1};  ///< descriptors of its standard streams; -1: /dev/null
    int folder = -1;                            ///< descriptor of its working folder; -1: that of this process
    std::optional<std::int64_t> memory = {};    ///< RLIMIT_AS, bytes; otherwise as here
    std::optional<std::int64_t> file = {};      ///< RLIMIT_FSIZE, bytes; otherwise as here
    /// Somebody else's: it gets no other descriptor of this process and no blocked or ignored signal, writes no core
    /// and is killed when this process ends. This thread waits until the program runs or has failed to. Another process
    /// is not waited for, because a dead file server may keep it for ever: one that cannot be executed says so in its
    /// standard error and ends.
    bool stranger = false;
};

/// -1, and why in `error`, where there is no process to be had or a stranger's program cannot be executed.
[[nodiscard]] pid_t start_process(const ProcessStart& start, std::error_code& error);

/// The path of a program: as it is where the word has a slash, else by the search path. Empty: there is none that may
/// be executed.
[[nodiscard]] std::string find_program(const std::string& word);

// What the status of a process that ended, as of waitpid(2), says.
/// The signal that ended it, also where a launcher or a shell reports it by an exit code; 0: none.
[[nodiscard]] int ending_signal(int status);
/// Whether it was ended by something else than what it computed: by a signal that asks, or by Slurm, which says in the
/// log where it ends a step for its time limit, a pre-emption or a failed node.
[[nodiscard]] bool ended_from_outside(int status, std::string_view log);
/// "worker ended by signal 9 (Killed)".
[[nodiscard]] std::string describe_end(std::string_view what, int status);

}  // namespace grainsweep::workers
