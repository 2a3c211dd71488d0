// How many workers compute a campaign, and how they are started.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/workers/pool.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace grainsweep::cli {

/// `asked` overrides the campaign file's; with hosts, of each host. 0: all cores of the job, divided by those that each
/// case takes.
[[nodiscard]] std::size_t worker_count(const campaign::Campaign& campaign, std::optional<std::int64_t> asked);
/// Of every case from its beginning to its end; programs have cores instead, which count as one.
[[nodiscard]] unsigned threads_of_a_case(const campaign::Campaign& campaign);
struct WorkerFolders {
    std::filesystem::path artefacts;  ///< shared starting states and checkpoints
    std::filesystem::path cases;      ///< of cases that a program answers
};
/// `path`: instruction path of the workers, empty: each the widest it has.
[[nodiscard]] workers::PoolOptions pool_options(const campaign::Campaign& campaign, const WorkerFolders& folders,
                                                std::size_t workers, const std::string& path);
/// Throws campaign::WrongQuestion.
void refuse_launcher_that_is_not_there(const campaign::Campaign& campaign, const std::filesystem::path& config);

}  // namespace grainsweep::cli
