// A CSV file that a campaign file names, as text.
#pragma once

#include "sweep/campaign/cursor.hpp"

#include <filesystem>
#include <string>

namespace grainsweep::campaign {

/// The whole file. `file`: the place in the campaign file that names it, for refusals: no such
/// file, larger than 256 MiB, not readable to its end.
[[nodiscard]] std::string read_csv_text(const Cursor& file, const std::filesystem::path& path);

}  // namespace grainsweep::campaign
