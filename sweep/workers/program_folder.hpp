// The folder of one case: made empty, filled with the program's files, read within its own bounds, kept or removed.
#pragma once

#include "sweep/files/descriptor.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace grainsweep::workers {

class ProgramFolder {
public:
    /// A new empty folder; what has its name is removed first. Throws BrokenWorld where it cannot be made.
    explicit ProgramFolder(std::filesystem::path path);
    ProgramFolder(const ProgramFolder&) = delete;
    ProgramFolder& operator=(const ProgramFolder&) = delete;
    /// Removes it with all that is in it, unless it was kept.
    ~ProgramFolder();

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    [[nodiscard]] int descriptor() const { return folder_.number(); }

    /// A file of its own for the case, with the folders that its name says. Throws BrokenWorld.
    void write(const std::string& name, std::string_view contents, bool executable) const;
    void copy(const std::string& name, const std::filesystem::path& from, bool executable) const;
    /// A new file, to write to.
    [[nodiscard]] files::Descriptor create(const std::string& name) const;

    /// A file that the program left: a regular one, reached without links, of at most so many bytes. Else why not, in
    /// words that follow the file's name, and nothing.
    [[nodiscard]] std::optional<std::string> read(const std::string& name, std::size_t most_bytes,
                                                  std::string& why) const;
    [[nodiscard]] bool has(const std::string& name) const;
    /// The same, to read from; not open: why not.
    [[nodiscard]] files::Descriptor open(const std::string& name, std::string& why) const;
    /// The last bytes of a file, from the beginning of a line where there is one.
    [[nodiscard]] std::string end_of(const std::string& name, std::size_t bytes) const;

    struct Size {
        std::int64_t bytes = 0, files = 0;
        bool too_deep = false;  ///< folders within folders, more than 100
    };
    /// On disk, links not followed. Stops to count at `most` bytes, a million files or a folder that lies too deep.
    [[nodiscard]] Size size(std::int64_t most) const;

    /// Keeps it under another name beside this one, in the place of what has that name.
    void keep_as(const std::string& name);

private:
    [[nodiscard]] files::Descriptor parent_of(const std::string& name, std::string& leaf) const;

    std::filesystem::path path_;
    files::Descriptor folder_;
    bool kept_ = false;
};

/// How the name of a folder ends whose case is under way: what a dead run leaves of them is removed.
inline constexpr std::string_view running_suffix = ".running";
/// Removes every such folder.
void sweep_program_folders(const std::filesystem::path& cases);

}  // namespace grainsweep::workers
