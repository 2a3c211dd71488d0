// The child's side: reads questions from standard input, computes them one by one, writes answers to standard output.
// Ends when asked to stop, when its main program is gone or wrote nonsense, when it gets no message for too long, and
// on the signals by which systems ask a process to end (TERM, INT, HUP, USR1, USR2): then it saves a checkpoint and
// gives back what it has.
#pragma once

#include "sweep/campaign/case.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace grainsweep::workers {

struct WorkerOptions {
    std::filesystem::path artefacts;  ///< folder of shared starting states and checkpoints; empty: keep none
    double checkpoint_seconds = 60;   ///< a running case is saved this often
    /// Silence after which the main program is taken for dead, in this process's running time. Longer than a main
    /// program is stopped in earnest (Ctrl-Z); one whose end can be seen is not waited for.
    double lease_seconds = 600;
    double finish_seconds = 3;  ///< after the main program's stop, a case that can finish within this does
    /// After a stop or a signal, a case that has not come to a point where it can be saved is given back as it is.
    double give_back_seconds = 20;
    std::filesystem::path cases;  ///< its cases are answered by programs, and this holds their folders; empty: none is
    std::optional<double> limit_seconds;  ///< of a case that a program answers
    campaign::Computer computer;          ///< reported to the main program; checkpoints of another build are not used
};

/// The name under which an unfinished case's state is kept beside the database.
[[nodiscard]] std::string checkpoint_key(const campaign::CaseId& id, const campaign::Computer& program);
/// The case of a checkpoint of any build and instruction path; nothing where the key is of something else.
[[nodiscard]] std::optional<campaign::CaseId> checkpointed_case(std::string_view key);

/// Returns the exit code of the process.
int work(const WorkerOptions& options);

}  // namespace grainsweep::workers
