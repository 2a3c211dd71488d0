// Folder of one case. It is made empty, filled with the program's files, read with limits on sizes, then kept or
// removed.
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
    /// Makes a new empty folder; an older one with its name is removed first. Throws SystemError if it cannot be made.
    explicit ProgramFolder(std::filesystem::path path);
    struct Kept {};
    /// Opens the folder of an earlier case for reading; is_open() is false if there is none.
    ProgramFolder(Kept, std::filesystem::path path);
    ProgramFolder(const ProgramFolder&) = delete;
    ProgramFolder& operator=(const ProgramFolder&) = delete;
    /// Removes the folder with its contents, unless it was kept.
    ~ProgramFolder();

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    [[nodiscard]] int descriptor() const { return folder_.number(); }
    [[nodiscard]] bool is_open() const { return folder_.is_open(); }

    /// Writes a file of the case, and makes the folders in its name. Throws SystemError.
    void write(const std::string& name, std::string_view contents, bool executable) const;
    void copy(const std::string& name, const std::filesystem::path& from, bool executable) const;
    /// Makes a new file for writing.
    [[nodiscard]] files::Descriptor create(const std::string& name) const;

    /// Returns the contents of a file that the program wrote: a regular file, reached without links, of at most
    /// `most_bytes`. Otherwise returns nothing and sets `why`, words that follow the file's name in a sentence.
    [[nodiscard]] std::optional<std::string> read(const std::string& name, std::size_t most_bytes,
                                                  std::string& why) const;
    [[nodiscard]] bool has(const std::string& name) const;
    /// Opens such a file for reading. Sets `why` if it cannot be opened.
    [[nodiscard]] files::Descriptor open(const std::string& name, std::string& why) const;
    /// Returns the last bytes of a file, from the beginning of a line if possible.
    [[nodiscard]] std::string end_of(const std::string& name, std::size_t bytes) const;

    struct Size {
        std::int64_t bytes = 0, files = 0;
        bool too_deep = false;  ///< folders within folders, more than 100
    };
    /// Returns the size on disk; links are not followed. Stops counting at `most` bytes, a million files, or a folder
    /// that is nested too deep.
    [[nodiscard]] Size size(std::int64_t most) const;

    /// Keeps the folder under another name beside the present one, replacing a folder of that name.
    void keep_as(const std::string& name);

private:
    [[nodiscard]] files::Descriptor parent_of(const std::string& name, std::string& leaf) const;

    std::filesystem::path path_;
    files::Descriptor folder_;
    bool kept_ = false;
};

/// Suffix of the folder of a running case. Such folders of a dead run are removed.
inline constexpr std::string_view running_suffix = ".running";
/// Removes every folder with this suffix.
void sweep_program_folders(const std::filesystem::path& cases);

}  // namespace grainsweep::workers
