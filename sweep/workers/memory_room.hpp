// Memory that a process of this machine can have.
#pragma once

#include "sweep/campaign/campaign.hpp"

#include <string>

namespace grainsweep::workers {

/// Bytes: the least of the machine's memory, the limits of the control groups (v1, v2) that this process is in, and its
/// own limit of address space; infinite where none can be read. `root`: where /proc and /sys/fs/cgroup are found.
[[nodiscard]] double memory_room(const std::string& root = "");
/// The same for the workers of a campaign; infinite where a launcher starts them elsewhere.
[[nodiscard]] double memory_room(const campaign::Campaign& campaign);

}  // namespace grainsweep::workers
