#include "sweep/store/writer_lock.hpp"

#include "sweep/store/broken_world.hpp"
#include "sweep/store/moment.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <utility>

namespace grainsweep::store {

namespace {

std::string host() {
    std::array<char, 256> name{};
    return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "?";
}

std::string boot() {
    std::string id = "?";
    std::ifstream("/proc/sys/kernel/random/boot_id") >> id;
    return id;
}

}  // namespace

WriterLock::WriterLock(const std::filesystem::path& database) {
    // Through links, so that two names of one database share the lock.
    auto file = std::filesystem::weakly_canonical(database);
    file += ".lock";
    descriptor_ = open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0) {
        throw BrokenWorld(fmt::format("database '{}': its lock '{}' cannot be made: {}", database.string(),
                                      file.string(), std::strerror(errno)));
    }
    if (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
        const int number = errno;
        std::array<char, 512> text{};
        const auto length = pread(descriptor_, text.data(), text.size(), 0);
        close(std::exchange(descriptor_, -1));
        if (number != EWOULDBLOCK) {
            throw BrokenWorld(
                fmt::format("database '{}': this file system gives no locks ({}); keep the database on one "
                            "that does",
                            database.string(), std::strerror(number)));
        }
        const std::string holder(text.data(), length > 0 ? static_cast<std::size_t>(length) : 0);
        throw BrokenWorld(
            fmt::format("database '{}': {} is writing to it; one run at a time", database.string(),
                        holder.empty() ? "another run" : "the run of " + holder.substr(0, holder.find('\n'))));
    }
    // For people: the lock itself is the kernel's.
    const std::string text = fmt::format("process {} on {} since {}\nboot {}\n", getpid(), host(), utc_now(), boot());
    if (ftruncate(descriptor_, 0) != 0 ||
        pwrite(descriptor_, text.data(), text.size(), 0) != static_cast<ssize_t>(text.size())) {
        const int number = errno;
        close(std::exchange(descriptor_, -1));
        throw BrokenWorld(fmt::format("database '{}': its lock '{}' cannot be written: {}", database.string(),
                                      file.string(), std::strerror(number)));
    }
}

WriterLock::WriterLock(WriterLock&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

WriterLock::~WriterLock() {
    if (descriptor_ < 0) return;
    // The file stays: removing it would let two writers lock two files of one name.
    [[maybe_unused]] const int emptied = ftruncate(descriptor_, 0);
    close(descriptor_);
}

bool is_network_file_system(long magic) {
    // linux/magic.h and the sources of the file systems.
    constexpr std::array<std::uint32_t, 16> network = {
        0x6969,      // NFS
        0x517B,      // SMB
        0xFE534D42,  // SMB 2
        0xFF534D42,  // CIFS
        0x0BD00BD0,  // Lustre
        0x47504653,  // GPFS
        0x19830326,  // BeeGFS
        0x65735546,  // FUSE: sshfs and its like
        0x00C36400,  // Ceph
        0x5346414F,  // AFS
        0x6B414653,  // kAFS
        0x01021997,  // 9P
        0x73757245,  // Coda
        0xAAD7AAEA,  // PanFS
        0x01161970,  // GFS2
        0x7461636F,  // OCFS2
    };
    return std::ranges::find(network, static_cast<std::uint32_t>(magic)) != network.end();
}

bool on_network(const std::filesystem::path& file) {
    struct statfs system {};
    const auto folder = std::filesystem::weakly_canonical(file).parent_path();
    return statfs(folder.c_str(), &system) == 0 && is_network_file_system(static_cast<long>(system.f_type));
}

}  // namespace grainsweep::store
