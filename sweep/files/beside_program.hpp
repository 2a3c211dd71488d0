// Data that an archive of the program carries along, so that the archive can be unpacked anywhere.
#pragma once

#include <filesystem>
#include <string_view>

namespace grainsweep::files {

/// Returns the path of a data file beside the program, ../share/grainsweep/NAME. The file may not exist: a package of
/// the distribution takes the system's file.
[[nodiscard]] std::filesystem::path beside_program(std::string_view name);

}  // namespace grainsweep::files
