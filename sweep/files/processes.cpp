#include "sweep/files/processes.hpp"

#include "sweep/files/whole_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <system_error>

namespace grainsweep::files {

std::string own_host() {
    std::array<char, 65> host{};
    gethostname(host.data(), host.size() - 1);
    return host.data();
}

bool process_runs(pid_t process) {
    if (kill(process, 0) != 0) return errno != ESRCH;
    std::error_code error;
    const std::string line = whole_file(fmt::format("/proc/{}/stat", process), error);
    if (error == std::errc::no_such_process) return false;  // it ended between opening and reading
    const auto name_end = line.rfind(") ");                 // the name before it may hold anything
    return name_end == std::string::npos || line.compare(name_end + 2, 1, "Z") != 0;
}

}  // namespace grainsweep::files
