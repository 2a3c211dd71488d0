// Memory that a process can use on this machine.
#pragma once

#include "sweep/campaign/campaign.hpp"

#include <string>

namespace grainsweep::workers {

/// Returns the bytes: the smallest of the machine's memory, the limits of the control groups (v1, v2) of this process,
/// and its limit of address space. Infinite if none can be read. `root`: parent folder of /proc and /sys/fs/cgroup.
[[nodiscard]] double memory_room(const std::string& root = "");
/// Returns the same for the workers of a campaign; infinite if a launcher starts them on other machines.
[[nodiscard]] double memory_room(const campaign::Campaign& campaign);

}  // namespace grainsweep::workers
