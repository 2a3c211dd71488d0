#include "sweep/files/locked_files.hpp"

#include <sys/stat.h>

#include <map>
#include <mutex>

namespace grainsweep::files {
namespace {

struct Entries {
    std::mutex mutex;
    std::map<LockedFile::Id, int> count;
};

Entries& entries() {
    static Entries all;
    return all;
}

LockedFile::Id id_of(const std::filesystem::path& file) {
    struct stat about {};
    return ::stat(file.c_str(), &about) == 0 ? LockedFile::Id(about.st_dev, about.st_ino) : LockedFile::Id();
}

}  // namespace

LockedFile::LockedFile(const std::filesystem::path& file) : id_(id_of(file)) {
    if (id_ == Id()) return;
    const std::lock_guard lock(entries().mutex);
    ++entries().count[id_];
}

LockedFile::~LockedFile() {
    if (id_ == Id()) return;
    const std::lock_guard lock(entries().mutex);
    const auto found = entries().count.find(id_);
    if (--found->second == 0) entries().count.erase(found);
}

bool is_locked_file(const std::filesystem::path& file) {
    const auto id = id_of(file);
    const std::lock_guard lock(entries().mutex);
    return entries().count.contains(id);
}

}  // namespace grainsweep::files
