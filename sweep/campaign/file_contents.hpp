// Contents of files by their hash: made by the program, or taken from an archive. They stand
// before what lies at the path of a file.
#pragma once

#include "solver/scenes/values.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace grainsweep::campaign {

/// Makes contents known to this process, for its lifetime.
void enter_contents(std::string contents);
/// None where nothing of that hash was entered.
[[nodiscard]] std::optional<std::string> known_contents(std::string_view hash);

/// The value of a parameter that is a file made by the program: its path is a name without a folder, "ti64.json sizes".
/// Its contents are made known.
[[nodiscard]] std::string made_file_word(std::string_view name, std::string contents);
/// Whether no file on disk has the contents.
[[nodiscard]] bool is_made(const FileWord& file);

/// Returns the contents of one file, known or read; otherwise why it cannot be used, as a clause. What has changed
/// since it was named is no answer to the question. Throws BrokenWorld where a file is there and cannot be read.
struct FileContents {
    std::string text;
};
[[nodiscard]] std::variant<FileContents, std::string> contents_of(const FileWord& file);
/// The same of all files that inputs name; the reason names the parameter.
[[nodiscard]] std::variant<Files, std::string> files_named(const Inputs& inputs);

}  // namespace grainsweep::campaign
