// How many cores this process may use: those of its job or container, not those of the machine.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace grainsweep::workers {

/// The least of: processors that the system lets this process run on; the quota of its control groups; what Slurm gives
/// its task. At least 1. Found once.
[[nodiscard]] std::size_t job_cores();

/// Whole cores that the processor-time quotas of this process's control groups allow, at least 1; none: no quota. The
/// quota of every group above its own counts. Version 2: cpu.max; version 1: cpu.cfs_quota_us over cpu.cfs_period_us.
/// `root`: of the file system.
[[nodiscard]] std::optional<std::size_t> quota_cores(const std::filesystem::path& root);

/// Value of an environment variable; nothing: not set.
using Environment = std::function<std::optional<std::string>(const char* name)>;
/// Cores that Slurm gives this task; none: no job, or it does not say. A step's task has SLURM_CPUS_PER_TASK; a job's
/// script has these for each task of its node, or SLURM_CPUS_ON_NODE.
[[nodiscard]] std::optional<std::size_t> slurm_cores(const Environment& environment);

}  // namespace grainsweep::workers
