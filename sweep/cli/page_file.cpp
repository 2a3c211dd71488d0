#include "sweep/cli/page_file.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/files/aside_file.hpp"
#include "sweep/files/locked_files.hpp"
#include "sweep/files/system_error.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>

namespace grainsweep::cli {

namespace fs = std::filesystem;

void check_page_file(std::string_view option, const std::string& output, const std::string& database,
                     const FileKind& kind) {
    const auto refuse = [&](std::string_view why) {
        throw campaign::input_error(std::string(option), fmt::format("'{}'", output), std::string(why));
    };
    std::error_code error;
    const auto there = fs::status(output, error);
    if (there.type() == fs::file_type::none) refuse(error.message());
    if (fs::is_directory(there)) refuse("this is a folder; name a file");
    const auto folder = fs::path(output).parent_path();
    if (!fs::is_directory(folder.empty() ? "." : folder, error)) refuse("there is no such folder");
    if (fs::exists(there) && !fs::is_regular_file(there)) return;  // a pipe, a terminal
    if (access(folder.empty() ? "." : folder.c_str(), W_OK | X_OK) != 0) refuse(std::strerror(errno));
    for (const auto* suffix : {"", "-wal", "-shm", "-journal", ".lock"})
        if (!database.empty() && fs::weakly_canonical(output, error) == fs::weakly_canonical(database + suffix, error))
            refuse("this belongs to the database");
    if (files::is_locked_file(output) || (!database.empty() && fs::equivalent(output, database, error)))
        refuse("this is the database, under another name");
    if (!fs::exists(there)) return;
    std::ifstream stream(output, std::ios::binary);
    if (!stream || access(output.c_str(), W_OK) != 0) refuse(std::strerror(errno));
    std::string start(kind.start.size(), '\0');
    stream.read(start.data(), static_cast<std::streamsize>(start.size()));
    if (stream.gcount() == 0) return;
    std::ranges::transform(start, start.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (start != kind.start) refuse(fmt::format("this file exists and is not a {}; choose another name", kind.word));
}

void check_converted_file(const std::string& output, const std::string& input, std::string_view kind_of_input,
                          const FileKind& kind) {
    if (output.empty()) throw campaign::input_error("-o", "", fmt::format("name the {} to write", kind.word));
    std::error_code error;
    if (fs::equivalent(output, input, error))
        throw campaign::input_error("-o", output,
                                    fmt::format("this is the {} itself; name another file", kind_of_input));
    check_page_file("-o", output, "", kind);
}

void write_page_file(const std::string& output, const std::string& page) {
    std::error_code ignored;
    const bool link_to_nowhere = fs::is_symlink(fs::symlink_status(output, ignored)) && !fs::exists(output, ignored);
    if (link_to_nowhere || (fs::exists(output, ignored) && !fs::is_regular_file(output, ignored))) {
        errno = 0;
        std::ofstream stream(output, std::ios::binary);
        stream << page << std::flush;
        if (!stream) throw SystemError(fmt::format("'{}': cannot be written: {}", output, std::strerror(errno)));
        return;
    }
    files::AsideFile file(fs::weakly_canonical(output));  // through links: the page is where the link points
    file.write(page);
    file.take_place();
}

}  // namespace grainsweep::cli
