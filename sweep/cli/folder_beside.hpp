// Where a run keeps what is not in its database: folders of the same name beside it.
#pragma once

#include <filesystem>
#include <string_view>

namespace grainsweep::cli {

/// "x" + extension for x.db, in its folder; never the file itself. Absolute.
[[nodiscard]] inline std::filesystem::path folder_beside(const std::filesystem::path& file,
                                                         std::string_view extension) {
    std::filesystem::path folder = std::filesystem::absolute(file);
    if (folder.extension() == extension) return folder += extension;
    return folder.replace_extension(extension);
}

inline constexpr std::string_view of_artefacts = ".artefacts";
/// Of the cases that a program answers.
inline constexpr std::string_view of_cases = ".cases";

}  // namespace grainsweep::cli
