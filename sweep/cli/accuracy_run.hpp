// `accuracy`: the same points of a campaign at every setting of the numerics, and with every single numerical input of
// a cheaper setting beside the most accurate one.
//
// Each is a campaign, NAME_fast, NAME_reference_precision_mixed, ..., in a separate database. The same command
// continues after an interruption, and more points extend the campaigns.
#pragma once

#include "sweep/campaign/campaign.hpp"
#include "sweep/study/accuracy.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace grainsweep::cli {

/// Numerics of one campaign.
struct Numerics {
    std::string name;  ///< of its campaign
    std::string says;
    std::string text;    ///< its campaign file
    bool moved = false;  ///< one input differs from the setting that it names
};

/// The settings of the campaign's scene, then single inputs, then `against`. Throws WrongQuestion for a scene without
/// settings, a setting that it has not, and a campaign whose points follow from answers.
[[nodiscard]] std::vector<Numerics> numerics_of(const campaign::Campaign& campaign, const std::string& against,
                                                std::int64_t points);

struct AccuracyRun {
    std::filesystem::path config, database;
    std::string against = "reference";
    std::int64_t points = 32;
    std::optional<std::int64_t> workers;
    bool quiet = false;
};

struct AccuracyEnd {
    std::string campaign;
    std::vector<study::NumericsCost> costs;  ///< the last is `against`
    int exit_code = 0;                       ///< 0, or the exit code of an interrupted run
};

[[nodiscard]] AccuracyEnd run_accuracy(const AccuracyRun& run);

}  // namespace grainsweep::cli
