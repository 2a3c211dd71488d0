#include "sweep/store/writer_lock.hpp"

#include "sweep/campaign/input_error.hpp"
#include "sweep/files/system_error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <utility>

namespace grainsweep::store {

namespace {

// Far above the bytes at 2^30 that SQLite locks, and above any size a database has.
constexpr off_t locked_byte = off_t{1} << 61U;

[[noreturn]] void fail_to(const std::filesystem::path& database, const char* what, int number) {
    throw SystemError(fmt::format("database '{}': {}: {}", database.string(), what, std::strerror(number)));
}

struct flock locked_range(short kind) {
    struct flock range {};
    range.l_type = kind;
    range.l_whence = SEEK_SET;
    range.l_start = locked_byte;
    range.l_len = 1;
    return range;
}

}  // namespace

// The lock belongs to an open file description (F_OFD_SETLK), SQLite's locks belong to the process. So neither kind
// releases the other. The descriptor is SQLite's, because closing another one would release what SQLite holds. SQLite
// may keep it for another connection, so the lock is given back before.
std::optional<WriterLock> WriterLock::take(int descriptor, const std::filesystem::path& database) {
    auto range = locked_range(F_WRLCK);
    if (fcntl(descriptor, F_OFD_SETLK, &range) == 0) return WriterLock(descriptor);
    const int number = errno;
    if (number == EAGAIN || number == EACCES) return std::nullopt;
    fail_to(database, "this file system gives no locks; keep the database on one that does", number);
}

WriterLock::~WriterLock() {
    auto range = locked_range(F_UNLCK);
    if (descriptor_ >= 0) fcntl(descriptor_, F_OFD_SETLK, &range);
}

bool WriterLock::is_taken(int descriptor) {
    auto range = locked_range(F_WRLCK);
    return fcntl(descriptor, F_OFD_GETLK, &range) == 0 && range.l_type != F_UNLCK;
}

std::string_view network_file_system(long magic) {
    // linux/magic.h and the sources of the file systems.
    static constexpr std::array<std::pair<std::uint32_t, std::string_view>, 16> network = {{
        {0x6969, "NFS"},
        {0x517B, "SMB"},
        {0xFE534D42, "SMB 2"},
        {0xFF534D42, "CIFS"},
        {0x0BD00BD0, "Lustre"},
        {0x47504653, "GPFS"},
        {0x19830326, "BeeGFS"},
        {0x65735546, "FUSE"},  // sshfs and its like
        {0x00C36400, "Ceph"},
        {0x5346414F, "AFS"},
        {0x6B414653, "kAFS"},
        {0x01021997, "9P"},
        {0x73757245, "Coda"},
        {0xAAD7AAEA, "PanFS"},
        {0x01161970, "GFS2"},
        {0x7461636F, "OCFS2"},
    }};
    const auto found =
        std::ranges::find(network, static_cast<std::uint32_t>(magic), &decltype(network)::value_type::first);
    return found == network.end() ? std::string_view() : found->second;
}

long file_system_of(const std::filesystem::path& file) {
    struct statfs system {};
    const auto folder = std::filesystem::weakly_canonical(file).parent_path();
    return statfs(folder.c_str(), &system) == 0 ? static_cast<long>(system.f_type) : 0;
}

void refuse_network(const std::filesystem::path& database, long magic) {
    const auto name = network_file_system(magic);
    if (name.empty()) return;
    throw campaign::InputError(fmt::format(
        "'{}' lies on a network file system ({}), where two nodes may both write a database: give --db a file on a "
        "disk of this machine and copy it afterwards, or compute with 'grainsweep work' and collect there, or say "
        "--network-disk where one node at a time is all that ever writes it",
        database.string(), name));
}

}  // namespace grainsweep::store
