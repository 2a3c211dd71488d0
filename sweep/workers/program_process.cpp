#include "sweep/workers/program_process.hpp"

#include "sweep/files/system_error.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <stdexcept>

namespace grainsweep::workers {
namespace {

double seconds_of(const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

ProgramProcess::ProgramProcess(ProcessStart start, ProgramGuard& guard) : guard_(guard) {
    start.stranger = true;
    start.environment.push_back(guard.mark());
    std::error_code error;
    id_ = start_process(start, error);
    if (id_ < 0 && (error == std::errc::resource_unavailable_try_again || error == std::errc::not_enough_memory))
        throw SystemError(fmt::format("a program cannot be started: {}", error.message()));
    if (id_ < 0)
        throw std::runtime_error(fmt::format("'{}' cannot be executed: {}", start.argv.front(), error.message()));
    guard_.watch(id_);
    ended_ = files::Descriptor(static_cast<int>(::syscall(SYS_pidfd_open, id_, 0)));
}

ProgramProcess::~ProgramProcess() {
    if (!reaped_) end([] { return true; });
}

void ProgramProcess::reap(int options) {
    rusage used{};
    pid_t got = 0;
    do {
        got = ::wait4(id_, &result_.status, options, &used);
    } while (got < 0 && errno == EINTR);
    if (got != id_) return;
    reaped_ = true;
    result_.cpu_seconds = seconds_of(used.ru_utime) + seconds_of(used.ru_stime);
    result_.peak_memory = 1024.0 * static_cast<double>(used.ru_maxrss);
    end_stragglers();
    guard_.watch(0);
}

bool ProgramProcess::wait(double seconds) {
    using Clock = std::chrono::steady_clock;
    if (reaped_) return true;
    const auto until =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    while (!reaped_) {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()).count();
        if (ended_.is_open()) {
            pollfd one{ended_.number(), POLLIN, 0};
            if (::poll(&one, 1, static_cast<int>(std::max<std::int64_t>(left, 0))) < 0 && errno != EINTR) break;
        } else if (left > 0) {  // a kernel without descriptors of processes
            const timespec a_moment{0, 1'000'000};
            ::nanosleep(&a_moment, nullptr);
        }
        reap(WNOHANG);
        if (Clock::now() >= until) break;
    }
    return reaped_;
}

void ProgramProcess::end(const std::function<bool()>& hurry) {
    if (reaped_) return;
    ::kill(-id_, SIGTERM);
    constexpr double look = 0.05;
    for (double waited = 0; waited < program_grace && !(hurry && hurry()); waited += look)
        if (wait(look)) return;
    ::kill(-id_, SIGKILL);
    reap(0);
}

/// Ends the processes that the program left behind: members of its group, and orphans, which are now children of this
/// process.
void ProgramProcess::end_stragglers() {
    ::kill(-id_, SIGKILL);
    constexpr int most_looks = 200;
    for (int look = 0; look < most_looks; ++look) {
        const pid_t got = ::waitpid(-1, nullptr, WNOHANG);
        if (got < 0 && errno == ECHILD) return;
        if (got > 0) {
            look = 0;
            continue;
        }
        std::array<char, 4096> list{};
        const auto path = fmt::format("/proc/self/task/{}/children", ::syscall(SYS_gettid));
        if (const files::Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC)); file.is_open()) {
            const ssize_t length = ::read(file.number(), list.data(), list.size() - 1);
            const char* at = list.data();
            for (char* end = nullptr; length > 0; at = end) {
                const long child = std::strtol(at, &end, 10);
                if (end == at || child <= 0) break;
                ::kill(static_cast<pid_t>(child), SIGKILL);
            }
        }
        const timespec a_moment{0, 1'000'000};
        ::nanosleep(&a_moment, nullptr);
    }
}

double ProgramProcess::cpu_seconds() const {
    if (reaped_) return result_.cpu_seconds;
    clockid_t clock{};
    timespec time{};
    if (::clock_getcpuclockid(id_, &clock) != 0 || ::clock_gettime(clock, &time) != 0) return 0;
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

}  // namespace grainsweep::workers
