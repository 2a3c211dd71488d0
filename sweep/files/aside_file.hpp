// A file written beside its final place and put there whole: readers see the old one or the new one, never a part.
#pragma once

#include "sweep/files/descriptor.hpp"

#include <filesystem>
#include <optional>
#include <string_view>

namespace grainsweep::files {

/// A file being written aside: gone unless it becomes what it was meant for. Errors are BrokenWorld.
class AsideFile {
public:
    /// Beside `target`, hidden, with a name of this process, thread and moment alone that ends in `extension`.
    explicit AsideFile(std::filesystem::path target);
    AsideFile(const AsideFile&) = delete;
    AsideFile& operator=(const AsideFile&) = delete;
    ~AsideFile();

    void write(std::string_view bytes);
    /// Syncs the file and renames it to the target, over what is there.
    void take_place();
    /// The same without syncing: for what no later run reads.
    void take_place_unsynced();

    static constexpr std::string_view extension = ".aside";
    /// Whether the process that writes, or wrote, this file aside still runs; nothing where that was on another host,
    /// or the name says nothing about it.
    [[nodiscard]] static std::optional<bool> writer_runs(const std::filesystem::path& file);

private:
    std::filesystem::path target_, file_;
    Descriptor descriptor_;
};

}  // namespace grainsweep::files
