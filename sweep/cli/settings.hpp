// Settings that a command is given: one by NAME=VALUE for every factor, or a CSV file of them.
#pragma once

#include "sweep/study/window_space.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace grainsweep::cli {

/// Every factor once. Throws WrongQuestion naming the factors that are missing, the nearest name of one there is not,
/// or a value that is no number or no level of its factor.
[[nodiscard]] study::Setting read_setting(std::span<const study::ModelFactor> factors,
                                          std::span<const std::string> assignments);

/// Some of the factors, each once and within its range. Throws WrongQuestion as read_setting does, and for a value
/// outside of the range.
[[nodiscard]] study::Held read_held(std::span<const study::ModelFactor> factors,
                                    std::span<const std::string> assignments);

/// A header that names every factor, in any order, then one setting a line.
[[nodiscard]] std::vector<study::Setting> read_settings_file(const std::filesystem::path& file,
                                                             std::span<const study::ModelFactor> factors);

}  // namespace grainsweep::cli
