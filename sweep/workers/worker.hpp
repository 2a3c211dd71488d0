// Main function of a worker process: reads cases from standard input, computes them one by one, and writes answers to
// standard output. It ends on a request to stop, and on the signals TERM, INT, HUP, USR1 and USR2. It also ends when
// its main program is gone, sends an invalid message, or is silent for too long. Before it ends, it saves a checkpoint
// and gives back its cases.
#pragma once

#include "sweep/campaign/case.hpp"
#include "sweep/files/artefacts.hpp"
#include "sweep/workers/compute.hpp"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace grainsweep::workers {

struct WorkerOptions {
    std::filesystem::path artefacts;  ///< folder of shared starting states and checkpoints; empty: none are stored
    double checkpoint_seconds = 60;   ///< a running case is saved this often
    /// Silence after which the main program counts as dead, in running time of this process. Longer than users usually
    /// stop a main program (Ctrl-Z). If the end of the main program is visible, the worker ends at once.
    double lease_seconds = 600;
    double finish_seconds = 3;  ///< after a request to stop, a case that can finish within this time is finished
    /// Time after a stop or a signal at which a case is given back without a checkpoint, if none could be saved until
    /// then.
    double give_back_seconds = 20;
    std::filesystem::path cases;          ///< folder of the cases that programs answer; empty: no program
    std::optional<double> limit_seconds;  ///< time limit of a case that a program answers
    campaign::Computer computer;          ///< reported to the main program; checkpoints of another build are not used
};

/// Returns the key of an unfinished case's checkpoint, which is stored beside the database.
[[nodiscard]] std::string checkpoint_key(const campaign::CaseId& id, const campaign::Computer& program);
/// Returns the case of a checkpoint of any build and instruction path; empty if the key is of something else.
[[nodiscard]] std::optional<campaign::CaseId> checkpointed_case(std::string_view key);
/// Returns the cases that this program does not continue, because other programs have saved all their checkpoints. Each
/// has a text "from the beginning: ..." that names one of these programs. `any_path`: workers on other computers may
/// have the instruction path of any checkpoint.
[[nodiscard]] std::map<campaign::CaseId, std::string> checkpoints_of_others(const files::ArtefactFolder& folder,
                                                                            const campaign::Computer& program,
                                                                            bool any_path);
/// Takes a picture of an unfinished case in the state of its checkpoint. Returns false if this program has none of it.
[[nodiscard]] bool shoot_checkpoint(const campaign::Case& question, const std::filesystem::path& artefacts,
                                    const campaign::Computer& program, const Camera& camera);

/// Runs a worker. Returns the exit code of the process.
int work(const WorkerOptions& options);

}  // namespace grainsweep::workers
