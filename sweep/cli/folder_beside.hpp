// Folders for data of a run outside its database; they have its name and lie beside it.
#pragma once

#include <filesystem>
#include <string_view>

namespace grainsweep::cli {

/// Returns "x" + extension for x.db, in its folder, as an absolute path; never the file itself.
[[nodiscard]] inline std::filesystem::path folder_beside(const std::filesystem::path& file,
                                                         std::string_view extension) {
    std::filesystem::path folder = std::filesystem::absolute(file);
    if (folder.extension() == extension) return folder += extension;
    return folder.replace_extension(extension);
}

inline constexpr std::string_view of_artefacts = ".artefacts";
/// Extension of the folder for cases that a program answers.
inline constexpr std::string_view of_cases = ".cases";

}  // namespace grainsweep::cli
