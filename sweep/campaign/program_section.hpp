// "program": read and checked with the files it names. Internal to the reader.
#pragma once

#include "sweep/campaign/cursor.hpp"
#include "sweep/campaign/program.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace grainsweep::campaign {

/// `top` is the campaign file: its factors, fixed values and calibration say which parameters there are, and whether
/// each is a number or a word. The version is not asked here.
[[nodiscard]] std::shared_ptr<const Program> read_program(const Section& top, const std::filesystem::path& folder);

/// Reads "files" and "templates" into the program.
void read_program_files(const Section& section, const std::filesystem::path& folder, Program& program);
/// Reads "observables".
void read_program_observables(const Section& section, Program& program);
/// A regular expression with a group, which is the value or the version.
[[nodiscard]] std::string read_output_pattern(const Cursor& place, std::string_view what);
/// [low, high], null for an open end.
[[nodiscard]] Interval read_program_bounds(const Cursor& place);
/// The name of a file within a case's folder; refuses what could lie elsewhere.
[[nodiscard]] std::string read_file_name(const Cursor& place);

}  // namespace grainsweep::campaign
