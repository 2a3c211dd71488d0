// Text of a CSV file that a campaign file names.
#pragma once

#include "sweep/campaign/cursor.hpp"

#include <filesystem>
#include <string>

namespace grainsweep::campaign {

/// Returns the contents of the file. Refuses a missing file, one larger than 256 MiB, and one that cannot be read to
/// its end. `file`: its place in the campaign file.
[[nodiscard]] std::string read_csv_text(const Cursor& file, const std::filesystem::path& path);

}  // namespace grainsweep::campaign
