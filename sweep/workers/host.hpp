// A host: the process that runs the workers of one node. A launcher (srun, ssh, mpirun) starts it once. It runs workers
// as its children and passes on the messages between them and the main program (host_frame.hpp). The pool makes all
// decisions: permitted messages, time limits, and the outcome of cases. The host passes signals that request its end on
// to its workers, which save and give back their cases; then it ends. If the host or its main program ends in any other
// way, its workers end, too.
#pragma once

#include <string>
#include <vector>

namespace grainsweep::workers {

struct HostOptions {
    std::vector<std::string> command;  ///< executable and arguments of a worker
    /// Silence after which the main program counts as dead, in running time of this process.
    double lease_seconds = 600;
};

/// Exit code of a host whose standard input does not come from a main program, or was damaged on its way.
inline constexpr int no_frames = 2;

/// Returns the exit code of the process.
int host(const HostOptions& options);

}  // namespace grainsweep::workers
