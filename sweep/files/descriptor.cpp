#include "sweep/files/descriptor.hpp"

#include "sweep/files/system_error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstring>

namespace grainsweep::files {

bool Descriptor::close() {
    return number_ < 0 || ::close(release()) == 0;
}

bool write_all(int descriptor, std::string_view bytes) {
    while (!bytes.empty()) {
        const auto written = ::write(descriptor, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return false;
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
}

void sync_folder(const std::filesystem::path& folder) {
    const Descriptor opened(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
    if (opened.is_open() && (::fsync(opened.number()) == 0 || errno == EINVAL)) return;  // EINVAL: it has no such syncs
    throw SystemError(fmt::format("'{}': cannot be synced: {}", folder.string(), std::strerror(errno)));
}

}  // namespace grainsweep::files
