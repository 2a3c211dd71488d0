#include "sweep/files/whole_file.hpp"

#include "sweep/files/descriptor.hpp"
#include "sweep/files/locked_files.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>

namespace grainsweep::files {

namespace {

std::string read_all(const std::filesystem::path& file, int flags, std::error_code& error, std::size_t most) {
    std::string bytes;
    error.clear();
    if (is_locked_file(file)) {
        error = std::make_error_code(std::errc::device_or_resource_busy);
        return bytes;
    }
    const Descriptor opened(::open(file.c_str(), O_RDONLY | O_CLOEXEC | flags));
    struct stat about {};
    if (!opened.is_open() || ((flags & O_NOFOLLOW) != 0 && ::fstat(opened.number(), &about) != 0)) {
        error.assign(errno, std::system_category());
        return bytes;
    }
    if ((flags & O_NOFOLLOW) != 0 && !S_ISREG(about.st_mode)) {
        error = std::make_error_code(std::errc::operation_not_supported);
        return bytes;
    }
    std::array<char, 65536> part;
    while (!error) {
        const ssize_t got = ::read(opened.number(), part.data(), part.size());
        if (got == 0) break;
        if (got > 0)
            bytes.append(part.data(), static_cast<std::size_t>(got));
        else if (errno != EINTR)
            error.assign(errno, std::system_category());
        if (bytes.size() > most) error = std::make_error_code(std::errc::file_too_large);
    }
    return bytes;
}

}  // namespace

std::string whole_file(const std::filesystem::path& file, std::error_code& error, std::size_t most) {
    return read_all(file, 0, error, most);
}

std::string regular_file(const std::filesystem::path& file, std::error_code& error, std::size_t most) {
    return read_all(file, O_NOFOLLOW | O_NONBLOCK, error, most);
}

}  // namespace grainsweep::files
