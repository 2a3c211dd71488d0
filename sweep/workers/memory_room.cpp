#include "sweep/workers/memory_room.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

namespace grainsweep::workers {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// The number that a file begins with; none for the word "max".
double limit_in(const std::filesystem::path& file) {
    std::ifstream in(file);
    double limit = 0;
    return in >> limit ? limit : unlimited;
}

double memory_of_machine(const std::string& root) {
    std::ifstream in(root + "/proc/meminfo");
    for (std::string word; in >> word;) {
        double kibibytes = 0;
        if (word == "MemTotal:" && in >> kibibytes) return 1024 * kibibytes;
    }
    return unlimited;
}

/// Of a group and those above it.
double limit_of_group(const std::string& mount, std::filesystem::path group, const char* file) {
    double least = unlimited;
    for (;; group = group.parent_path()) {
        least = std::min(least, limit_in(mount + group.string() + "/" + file));
        if (!group.has_relative_path()) return least;
    }
}

double limit_of_groups(const std::string& root) {
    std::ifstream in(root + "/proc/self/cgroup");
    double least = unlimited;
    for (std::string line; std::getline(in, line);) {  // number:controllers:/group
        std::istringstream parts(line);
        std::string number, controllers, group;
        if (!std::getline(parts, number, ':') || !std::getline(parts, controllers, ':') || !std::getline(parts, group))
            continue;
        const std::string mount = root + "/sys/fs/cgroup";
        if (controllers.empty()) least = std::min(least, limit_of_group(mount, group, "memory.max"));
        if (("," + controllers + ",").find(",memory,") != std::string::npos)
            least = std::min(least, limit_of_group(mount + "/memory", group, "memory.limit_in_bytes"));
    }
    return least;
}

double limit_of_process() {
    rlimit limit{};
    if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unlimited;
    return static_cast<double>(limit.rlim_cur);
}

}  // namespace

double memory_room(const std::string& root) {
    return std::min({memory_of_machine(root), limit_of_groups(root), limit_of_process()});
}

double memory_room(const campaign::Campaign& campaign) {
    return campaign.execution.launcher.empty() ? memory_room() : unlimited;
}

}  // namespace grainsweep::workers
