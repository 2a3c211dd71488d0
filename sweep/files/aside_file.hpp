// File that is written beside its final place and then moved there: readers see the old file or the complete new one.
#pragma once

#include "sweep/files/descriptor.hpp"

#include <filesystem>
#include <optional>
#include <string_view>

namespace grainsweep::files {

/// Temporary file, which is removed unless it takes its place. Errors are SystemError.
class AsideFile {
public:
    /// Makes a hidden file beside `target`, with a unique name of this process, thread and moment that ends in
    /// `extension`.
    explicit AsideFile(std::filesystem::path target);
    AsideFile(const AsideFile&) = delete;
    AsideFile& operator=(const AsideFile&) = delete;
    ~AsideFile();

    void write(std::string_view bytes);
    /// Syncs the file and renames it to the target, replacing an existing file.
    void take_place();
    /// Renames without syncing, for files that no later run reads.
    void take_place_unsynced();

    static constexpr std::string_view extension = ".aside";
    /// Returns whether the process that writes this temporary file still runs. Empty if it is on another host, or the
    /// name does not identify it.
    [[nodiscard]] static std::optional<bool> writer_runs(const std::filesystem::path& file);

private:
    std::filesystem::path target_, file_;
    Descriptor descriptor_;
};

}  // namespace grainsweep::files
