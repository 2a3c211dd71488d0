#include "sweep/files/aside_file.hpp"

#include "sweep/files/processes.hpp"
#include "sweep/files/system_error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

namespace grainsweep::files {
namespace {

[[noreturn]] void failed(const std::filesystem::path& file, std::string_view what) {
    throw SystemError(fmt::format("'{}': cannot be {}: {}", file.string(), what, std::strerror(errno)));
}

/// In the target's folder; the name does not grow with the target's.
std::filesystem::path aside_of(const std::filesystem::path& target) {
    static std::atomic<unsigned> count = 0;
    return target.parent_path() / fmt::format(".{}.{}.{}{}", own_host(), getpid(), count++, AsideFile::extension);
}

}  // namespace

AsideFile::AsideFile(std::filesystem::path target) : target_(std::move(target)), file_(aside_of(target_)) {
    descriptor_ = Descriptor(open(file_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (!descriptor_.is_open()) failed(target_, "made");
}

AsideFile::~AsideFile() {
    (void)descriptor_.close();
    if (!file_.empty()) unlink(file_.c_str());
}

std::optional<bool> AsideFile::writer_runs(const std::filesystem::path& file) {
    std::string name = file.stem().string();  // .host.process.count; a host's name may have dots
    const std::string start = fmt::format(".{}.", own_host());
    if (!name.starts_with(start)) return std::nullopt;
    name.erase(0, start.size());
    pid_t process = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), process);
    if (error != std::errc() || process <= 0 || end == name.data() + name.size() || *end != '.') return std::nullopt;
    return process_runs(process);
}

void AsideFile::write(std::string_view bytes) {
    if (!write_all(descriptor_.number(), bytes)) failed(target_, "written");
}

void AsideFile::take_place() {
    if (fsync(descriptor_.number()) != 0) failed(target_, "synced");
    take_place_unsynced();
}

void AsideFile::take_place_unsynced() {
    if (!descriptor_.close()) failed(target_, "closed");
    if (rename(file_.c_str(), target_.c_str()) != 0) failed(target_, "put in place");
    file_.clear();
}

}  // namespace grainsweep::files
