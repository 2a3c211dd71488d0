// Reader of the section "program" and the files that it names. Internal to the reader.
#pragma once

#include "sweep/campaign/cursor.hpp"
#include "sweep/campaign/program.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::campaign {

/// Reads the program. `top`: the campaign file, whose factors, fixed values and calibration define the parameters, and
/// whether each is a number or a word. Does not run the version command.
[[nodiscard]] std::shared_ptr<const Program> read_program(const Section& top, const std::filesystem::path& folder);

/// Returns the parameters that factors, fixed values and conditions of a calibration define, with what "parameters" of
/// the section states of each. A parameter is a number if it has a unit, bounds or "whole", or a number among its
/// values.
[[nodiscard]] std::vector<ProgramParameter> read_program_parameters(const Section& top, const Section& section);
/// Reads "accuracy" into the program, whose parameters are known.
void read_program_accuracy(const Section& section, Program& program);
/// Refuses a name of a parameter or an observable that cannot be a column in SQL.
void check_program_name(const Cursor& place, const std::string& name);
/// Refuses a name that differs from another one only by upper and lower case.
void check_name_in_sql(const Cursor& place, const std::string& name, const std::vector<std::string>& others);

/// Reads "files" and "templates" into the program.
void read_program_files(const Section& section, const std::filesystem::path& folder, Program& program);
/// Reads "observables".
void read_program_observables(const Section& section, Program& program);
/// Returns a regular expression with a group, which is the value or the version.
[[nodiscard]] std::string read_output_pattern(const Cursor& place, std::string_view what);
/// Reads [low, high], null for an open end; a text has a unit that fits `unit`.
[[nodiscard]] Interval read_program_bounds(const Cursor& place, const std::string& unit);
/// Returns the name of a file within a case's folder; refuses names that lead elsewhere.
[[nodiscard]] std::string read_file_name(const Cursor& place);

}  // namespace grainsweep::campaign
