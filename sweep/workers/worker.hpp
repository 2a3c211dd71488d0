// The child's side: reads questions from standard input, computes them one by one, writes answers to
// standard output. Ends when told to stop, when its boss is gone, or when it hears nothing for too long.
#pragma once

#include "sweep/campaign/case.hpp"

#include <filesystem>
#include <string>

namespace grainsweep::workers {

struct WorkerOptions {
    std::filesystem::path artefacts;  ///< folder of shared starting states and checkpoints; empty: keep none
    double checkpoint_seconds = 60;   ///< a running case is saved this often
    double lease_seconds = 60;        ///< silence after which the boss is taken for dead
    double park_seconds = 3;          ///< after a stop, a case that can finish within this does; else it is parked
    std::string version;              ///< told to the boss; checkpoints of another version are not used
};

/// The name under which an unfinished case's state is kept beside the database.
[[nodiscard]] std::string checkpoint_key(const campaign::CaseId& id, const std::string& version);

/// Returns the exit code of the process.
int work(const WorkerOptions& options);

}  // namespace grainsweep::workers
