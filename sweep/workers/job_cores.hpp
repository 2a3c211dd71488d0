// Cores that this process may use: the cores of its job or container, not of the machine.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace grainsweep::workers {

/// Returns the smallest of: the processors of this process's affinity mask, the quota of its control groups, and the
/// cores that Slurm gives its task. At least 1. Computed once.
[[nodiscard]] std::size_t job_cores();

/// Returns the whole cores that the processor-time quotas of this process's control groups allow, at least 1; empty: no
/// quota. The quotas of all parent groups count, too. Version 2: cpu.max; version 1: cpu.cfs_quota_us divided by
/// cpu.cfs_period_us. `root`: root of the file system.
[[nodiscard]] std::optional<std::size_t> quota_cores(const std::filesystem::path& root);

/// Function that returns the value of an environment variable; empty: not set.
using Environment = std::function<std::optional<std::string>(const char* name)>;
/// Returns the cores that Slurm gives this task; empty: no job, or Slurm does not state them. The task of a step has
/// SLURM_CPUS_PER_TASK. The script of a job has SLURM_CPUS_PER_TASK for each task of its node, or SLURM_CPUS_ON_NODE.
[[nodiscard]] std::optional<std::size_t> slurm_cores(const Environment& environment);

}  // namespace grainsweep::workers
