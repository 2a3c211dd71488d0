#include "sweep/workers/program_process.hpp"

#include "sweep/store/broken_world.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
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

extern "C" char** environ;  // NOLINT(readability-redundant-declaration): not in every <unistd.h>

namespace grainsweep::workers {
namespace {

/// All that the new process needs, made before it is: between its birth and its program it calls the kernel alone.
struct Prepared {
    const char* path = nullptr;
    char* const* argv = nullptr;
    char* const* environment = nullptr;
    int folder = -1;
    std::array<int, 3> streams{};
    rlim_t memory = 0, file = 0;
    pid_t parent = 0;
    volatile int failure = 0;  ///< errno of what went wrong; the memory is shared until the program runs
};

void limit(int resource, rlim_t most) {
    if (most == 0) return;
    const rlimit both{most, most};
    ::setrlimit(static_cast<__rlimit_resource>(resource), &both);
}

[[noreturn]] void become(Prepared& it) {
    ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != it.parent) ::_exit(127);
    for (int k = 0; k < 3; ++k)
        if (::dup2(it.streams[static_cast<std::size_t>(k)], k) < 0) it.failure = errno;
    if (::fchdir(it.folder) != 0) it.failure = errno;
    ::close_range(3, ~0U, 0);
    limit(RLIMIT_AS, it.memory);
    limit(RLIMIT_FSIZE, it.file);
    const rlimit no_core{0, 0};
    ::setrlimit(RLIMIT_CORE, &no_core);
    for (const int number : {SIGPIPE, SIGHUP, SIGINT, SIGTERM, SIGUSR1, SIGUSR2, SIGXFSZ}) ::signal(number, SIG_DFL);
    sigset_t none;
    ::sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    if (it.failure == 0) {
        ::execve(it.path, it.argv, it.environment);
        it.failure = errno;
    }
    ::_exit(127);
}

/// vfork(2): this thread waits until the program runs or has failed to, and nothing is copied.
pid_t give_birth(Prepared& it) {
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wdeprecated-declarations"
    const pid_t id = ::vfork();
#pragma GCC diagnostic pop
    if (id == 0) become(it);
    return id;
}

/// This process's variables and those given, a later one of a name in the place of an earlier.
std::vector<char*> environment_of(const std::vector<std::string>& given) {
    std::vector<char*> all;
    const auto name_of = [](std::string_view entry) { return entry.substr(0, entry.find('=')); };
    for (char** entry = environ; entry != nullptr && *entry != nullptr; ++entry) {
        const auto replaced = [&](const std::string& other) { return name_of(other) == name_of(*entry); };
        if (std::ranges::none_of(given, replaced)) all.push_back(*entry);
    }
    for (const auto& entry : given) all.push_back(const_cast<char*>(entry.c_str()));
    all.push_back(nullptr);
    return all;
}

int nothing_descriptor() {
    static const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
    return nothing;
}

double seconds_of(const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

bool may_be_executed(const std::string& path) {
    struct stat status {};
    return ::stat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode) && ::access(path.c_str(), X_OK) == 0;
}

}  // namespace

std::string find_program(const std::string& word) {
    if (word.find('/') != std::string::npos) return may_be_executed(word) ? word : std::string();
    const char* const listed = std::getenv("PATH");
    std::string_view rest = listed == nullptr ? "/usr/local/bin:/usr/bin:/bin" : listed;
    while (true) {
        const auto colon = rest.find(':');
        const std::string folder(rest.substr(0, colon));
        if (!folder.empty() && folder.front() == '/')  // else it would mean another folder in every case's
            if (auto path = folder + "/" + word; may_be_executed(path)) return path;
        if (colon == std::string_view::npos) return {};
        rest.remove_prefix(colon + 1);
    }
}

ProgramProcess::ProgramProcess(const ProgramStart& start, ProgramGuard& guard) : guard_(guard) {
    Prepared it;
    std::vector<char*> argv;
    for (const auto& word : start.argv) argv.push_back(const_cast<char*>(word.c_str()));
    argv.push_back(nullptr);
    auto given = start.environment;
    given.push_back(guard.mark());
    const auto environment = environment_of(given);
    it.path = start.argv.front().c_str();
    it.argv = argv.data();
    it.environment = environment.data();
    it.folder = start.folder;
    const auto stream = [](int wanted) { return wanted < 0 ? nothing_descriptor() : wanted; };
    it.streams = {stream(start.in), stream(start.out), stream(start.err)};
    it.memory = static_cast<rlim_t>(start.memory);
    it.file = static_cast<rlim_t>(start.file);
    it.parent = ::getpid();
    id_ = give_birth(it);
    if (id_ < 0) throw store::BrokenWorld(fmt::format("a program cannot be started: {}", std::strerror(errno)));
    if (it.failure != 0) {
        ::waitpid(id_, nullptr, 0);
        throw std::runtime_error(
            fmt::format("'{}' cannot be executed: {}", start.argv.front(), std::strerror(it.failure)));
    }
    guard_.watch(id_);
    ended_ = static_cast<int>(::syscall(SYS_pidfd_open, id_, 0));
}

ProgramProcess::~ProgramProcess() {
    if (!reaped_) end([] { return true; });
    if (ended_ >= 0) ::close(ended_);
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
        if (ended_ >= 0) {
            pollfd one{ended_, POLLIN, 0};
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

/// What the program left behind: members of its group, and orphans, which are now children of this process.
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
        if (const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC); file >= 0) {
            const ssize_t length = ::read(file, list.data(), list.size() - 1);
            ::close(file);
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

std::string end_in_words(int status) {
    if (WIFSIGNALED(status))
        return fmt::format("ended by signal {} ({})", WTERMSIG(status), ::strsignal(WTERMSIG(status)));
    return fmt::format("ended with exit code {}", WEXITSTATUS(status));
}

}  // namespace grainsweep::workers
