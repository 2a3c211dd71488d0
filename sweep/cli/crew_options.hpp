// Number of workers of a campaign, and options for starting them.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/workers/pool.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace grainsweep::cli {

/// Returns the number of workers, with hosts per host. `asked` overrides the campaign file. 0: all cores of the job,
/// divided by the cores of a case.
[[nodiscard]] std::size_t worker_count(const campaign::Campaign& campaign, std::optional<std::int64_t> asked);
/// Returns the fixed number of threads of every case; 1 for programs, which have cores instead.
[[nodiscard]] unsigned threads_of_a_case(const campaign::Campaign& campaign);
struct WorkerFolders {
    std::filesystem::path artefacts;  ///< shared starting states and checkpoints
    std::filesystem::path cases;      ///< folders of cases that a program answers
};
/// Returns the options of the pool. `path`: instruction path of the workers; empty: the widest of each.
[[nodiscard]] workers::PoolOptions pool_options(const campaign::Campaign& campaign, const WorkerFolders& folders,
                                                std::size_t workers, const std::string& path);
/// Throws campaign::InputError if the launcher does not exist.
void refuse_launcher_that_is_not_there(const campaign::Campaign& campaign, const std::filesystem::path& config);

}  // namespace grainsweep::cli
