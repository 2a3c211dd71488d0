// The bytes of a file from its beginning to its end. Streams read through iterators end a program by an exception that
// names no file where a disk fails, and take a file that cannot be opened for an empty one.
#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>
#include <system_error>

namespace grainsweep::files {

/// What could be read; `error` says why that is not all: no such file, no permission, a folder, a failing disk, more
/// than `most` bytes (file_too_large).
[[nodiscard]] std::string whole_file(const std::filesystem::path& file, std::error_code& error,
                                     std::size_t most = std::numeric_limits<std::size_t>::max());

}  // namespace grainsweep::files
