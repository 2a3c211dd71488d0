// Processes of this host.
#pragma once

#include <sys/types.h>

#include <string>

namespace grainsweep::files {

[[nodiscard]] std::string own_host();
/// Returns whether the process runs. One that has ended and whose parent has not taken note of it, as first processes
/// of containers do late or never, does not.
[[nodiscard]] bool process_runs(pid_t process);

}  // namespace grainsweep::files
