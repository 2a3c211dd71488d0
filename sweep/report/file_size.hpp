// How large a file is, for the line that says it was written.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace grainsweep::report {

/// 999 -> "999 B", 1234567 -> "1.2 MB"; decimal units, two digits below ten.
[[nodiscard]] std::string size_text(std::uintmax_t bytes);
/// "c.db (852 kB)"; the name alone where its size cannot be found.
[[nodiscard]] std::string named_with_size(const std::filesystem::path& file);

}  // namespace grainsweep::report
