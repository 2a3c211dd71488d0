// Size of a file, for the message that it was written.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace grainsweep::report {

/// Returns a size as text: 999 -> "999 B", 1234567 -> "1.2 MB"; decimal units, two digits below ten.
[[nodiscard]] std::string size_text(std::uintmax_t bytes);
/// Returns a text such as "c.db (852 kB)"; only the name if the size is unknown.
[[nodiscard]] std::string named_with_size(const std::filesystem::path& file);

}  // namespace grainsweep::report
