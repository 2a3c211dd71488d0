#include "sweep/files/whole_file.hpp"

#include "sweep/files/descriptor.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <cerrno>

namespace grainsweep::files {

std::string whole_file(const std::filesystem::path& file, std::error_code& error, std::size_t most) {
    std::string bytes;
    error.clear();
    const Descriptor opened(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
    if (!opened.is_open()) {
        error.assign(errno, std::system_category());
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

}  // namespace grainsweep::files
