// Reading of a complete file. Stream iterators are not used: on a failing disk they throw without the name of the file,
// and they treat a file that cannot be opened as empty.
#pragma once

#include <cstddef>
#include <filesystem>
#include <limits>
#include <string>
#include <system_error>

namespace grainsweep::files {

/// Returns the bytes that could be read. Sets `error` if these are not all: no such file, no permission, a folder, a
/// failing disk, more than `most` bytes (file_too_large), a database of this process (locked_files.hpp).
[[nodiscard]] std::string whole_file(const std::filesystem::path& file, std::error_code& error,
                                     std::size_t most = std::numeric_limits<std::size_t>::max());

/// Does the same for a file that anybody may have put there: its last name is no link, and it is a regular file. It
/// waits for no writer of a named pipe.
[[nodiscard]] std::string regular_file(const std::filesystem::path& file, std::error_code& error, std::size_t most);

}  // namespace grainsweep::files
