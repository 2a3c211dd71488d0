// Contents of files by their hash, made by the program or taken from a database. They take precedence over the file at
// the path.
#pragma once

#include "solver/scenes/values.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace grainsweep::campaign {

/// Registers contents in this process.
void enter_contents(std::string contents);
/// Returns registered contents; empty if there are none of this hash.
[[nodiscard]] std::optional<std::string> known_contents(std::string_view hash);

/// Registers the contents of a file made by the program, and returns the value of its parameter. Its path is a name
/// without a folder, "ti64.json sizes".
[[nodiscard]] std::string made_file_word(std::string_view name, std::string contents);
/// Returns whether the contents are in no file on disk.
[[nodiscard]] bool is_made(const FileWord& file);

/// Contents of one file, registered or read, or else the reason why it cannot be used, as a clause. A file that has
/// changed since the campaign was read is not used. Throws SystemError if a file exists but cannot be read.
struct FileContents {
    std::string text;
};
[[nodiscard]] std::variant<FileContents, std::string> contents_of(const FileWord& file);
/// Returns the contents of all files that inputs name, or a reason with the name of the parameter.
[[nodiscard]] std::variant<Files, std::string> files_named(const Inputs& inputs);

}  // namespace grainsweep::campaign
