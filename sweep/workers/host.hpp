// A host: the process that stands for a node. Started once, by whatever starts processes there (srun, ssh, mpirun), it
// runs workers as its children and passes on what they and the main program write to each other (host_frame.hpp). It
// decides nothing: what a worker may write, how long it may take and what becomes of its case is the pool's. Signals
// that ask it to end it passes on to its workers, which save what they have and give it back, and then it ends. When
// it ends in any other way, or its main program does, its workers end with it.
#pragma once

#include <string>
#include <vector>

namespace grainsweep::workers {

struct HostOptions {
    std::vector<std::string> command;  ///< executable and arguments of a worker
    /// Silence after which the main program is taken for dead, in this process's running time, as of a worker.
    double lease_seconds = 600;
};

/// Exit code of a host whose standard input is not the main program's, or was changed on its way.
inline constexpr int no_frames = 2;

/// Returns the exit code of the process.
int host(const HostOptions& options);

}  // namespace grainsweep::workers
