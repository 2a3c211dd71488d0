// Settings in the arguments of a command: one setting by NAME=VALUE for every factor, or a CSV file of settings.
#pragma once

#include "sweep/study/window_question.hpp"

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace grainsweep::cli {

/// Reads every factor once. Throws InputError with missing factors, the nearest name for an unknown factor, or a
/// value that is no number or level of its factor.
[[nodiscard]] study::Setting read_setting(std::span<const study::ModelFactor> factors,
                                          std::span<const std::string> assignments);

/// Reads some of the factors, each once and within its range. Throws InputError like read_setting, and for a value
/// outside the range.
[[nodiscard]] study::Held read_held(std::span<const study::ModelFactor> factors,
                                    std::span<const std::string> assignments);

/// Reads the reference values of objectives, each once. Throws InputError for another name or a value that is no
/// finite number.
void read_references(const study::ModelCases& cases, std::span<const std::string> assignments,
                     std::span<study::Objective> objectives);

/// Reads a file with a header that names every factor, in any order, then one setting per line.
[[nodiscard]] std::vector<study::Setting> read_settings_file(const std::filesystem::path& file,
                                                             std::span<const study::ModelFactor> factors);

}  // namespace grainsweep::cli
