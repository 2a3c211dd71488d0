// The powder file that a calibration writes: its result over the powder with which it ran.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace grainsweep::campaign {

/// Calibrated properties of a powder in SI units, and the measurements that gave them.
struct PowderResult {
    struct Measurement {
        std::string what, unit;
        double value = 0, error = 0;
    };
    std::vector<std::pair<std::string, double>> properties;  ///< parameters of the powder block
    std::vector<Measurement> measured;
    std::string posterior;  ///< name of its file
};

/// Text of a powder file, and the table of sizes that it needs beside it.
struct PowderText {
    std::string json;
    std::optional<std::pair<std::string, std::string>> sizes;  ///< name and contents; absent: none has to be written
};

/// Returns the powder `name`: the powder file with which the campaign of `config` ran (its own, of an experiment or of
/// a species), what the campaign fixes itself, and the result over both. "notes" states the origin of each. Its files
/// are for `folder`. A campaign without a powder file, or with several, has no base.
[[nodiscard]] PowderText powder_with(const std::filesystem::path& config, const std::string& name,
                                     const PowderResult& result, const std::filesystem::path& folder);

}  // namespace grainsweep::campaign
