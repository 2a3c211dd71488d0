// How many workers compute a campaign, and how they are started.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/workers/pool.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace grainsweep::cli {

/// `asked` overrides the campaign file's; with hosts, of each host. 0: all cores.
[[nodiscard]] std::size_t worker_count(const campaign::Execution& execution, std::optional<std::int64_t> asked);
/// `artefacts`: folder of shared starting states and checkpoints; `path`: instruction path of the workers, empty: each
/// the widest it has.
[[nodiscard]] workers::PoolOptions pool_options(const campaign::Campaign& campaign,
                                                const std::filesystem::path& artefacts, std::size_t workers,
                                                const std::string& path);
/// Throws campaign::WrongQuestion.
void refuse_launcher_that_is_not_there(const campaign::Campaign& campaign, const std::filesystem::path& config);

}  // namespace grainsweep::cli
