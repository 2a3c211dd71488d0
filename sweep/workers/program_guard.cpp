#include "sweep/workers/program_guard.hpp"

#include "sweep/files/system_error.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/random.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <new>
#include <string_view>

namespace grainsweep::workers {

struct ProgramGuard::Shared {
    std::atomic<pid_t> group{0};
};

namespace {

constexpr int looks_a_second = 20;

void pause_briefly() {
    const timespec a_moment{0, 1'000'000'000 / looks_a_second};
    ::nanosleep(&a_moment, nullptr);
}

/// Whether the process has the text among its environment. Zombies and other users' processes have none to show.
bool bears(const char* process, std::string_view mark) {
    std::array<char, 64> path{};
    *fmt::format_to_n(path.data(), path.size() - 1, "/proc/{}/environ", process).out = '\0';
    const int file = ::open(path.data(), O_RDONLY | O_CLOEXEC);
    if (file < 0) return false;
    std::string text;
    std::array<char, 4096> piece{};
    constexpr std::size_t longest = std::size_t{4} << 20U;
    for (ssize_t got = 0; text.size() < longest && (got = ::read(file, piece.data(), piece.size())) > 0;)
        text.append(piece.data(), static_cast<std::size_t>(got));
    ::close(file);
    return text.find(mark) != std::string::npos;
}

/// Sends the signal to every process that bears the mark; how many there are.
int signal_marked(std::string_view mark, int number) {
    DIR* const processes = ::opendir("/proc");
    if (processes == nullptr) return 0;
    int found = 0;
    while (const dirent* const entry = ::readdir(processes)) {
        const char* const name = entry->d_name;
        if (name[0] < '1' || name[0] > '9' || !bears(name, mark)) continue;
        ::kill(static_cast<pid_t>(std::strtol(name, nullptr, 10)), number);
        ++found;
    }
    ::closedir(processes);
    return found;
}

bool group_runs(pid_t group) {
    return group > 0 && ::kill(-group, 0) == 0;
}

/// Asks, waits, kills.
void end_all(pid_t group, std::string_view mark) {
    if (group > 0) ::kill(-group, SIGTERM);
    if (signal_marked(mark, SIGTERM) == 0 && !group_runs(group)) return;
    const int looks = static_cast<int>(program_grace * looks_a_second);
    for (int k = 0; k < looks && (group_runs(group) || signal_marked(mark, 0) > 0); ++k) pause_briefly();
    for (int k = 0; k < looks_a_second && (group_runs(group) || signal_marked(mark, 0) > 0); ++k) {
        if (group > 0) ::kill(-group, SIGKILL);
        signal_marked(mark, SIGKILL);
        pause_briefly();
    }
}

/// Nothing of the other process is held: its pipes must come to their end with it.
void keep_only(int descriptor) {
    ::dup2(descriptor, STDIN_FILENO);
    const int nothing = ::open("/dev/null", O_RDWR);
    ::dup2(nothing, STDOUT_FILENO);
    ::dup2(nothing, STDERR_FILENO);
    ::close_range(3, ~0U, 0);
}

[[noreturn]] void guard(int pipe, std::string_view mark, const std::atomic<pid_t>& group) {
    ::setsid();
    for (const int number : {SIGTERM, SIGINT, SIGHUP, SIGQUIT, SIGUSR1, SIGUSR2, SIGPIPE}) std::signal(number, SIG_IGN);
    ::prctl(PR_SET_NAME, "grainsweep-end");
    ::prctl(PR_SET_PDEATHSIG, 0);
    keep_only(pipe);
    char nothing = 0;
    while (true) {
        const ssize_t got = ::read(STDIN_FILENO, &nothing, 1);
        if (got == 0 || (got < 0 && errno != EINTR)) break;
    }
    end_all(group, mark);
    ::_exit(0);
}

}  // namespace

ProgramGuard::ProgramGuard() {
    const auto refuse = [](const char* what) {
        throw SystemError(fmt::format("programs cannot be watched over: {}: {}", what, std::strerror(errno)));
    };
    std::uint64_t number = 0;
    if (::getrandom(&number, sizeof number, 0) != sizeof number) number = static_cast<std::uint64_t>(::time(nullptr));
    mark_ = fmt::format("GRAINSWEEP_GUARD={}-{:016x}", ::getpid(), number);
    void* const memory = ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) refuse("no memory");
    shared_ = new (memory) Shared;
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) refuse("no pipe");
    const pid_t first = ::fork();
    if (first < 0) refuse("no process");
    if (first == 0) {  // its child belongs to no one who would have to wait for it
        ::close(ends[1]);
        if (::fork() == 0) guard(ends[0], mark_, shared_->group);
        ::_exit(0);
    }
    ::close(ends[0]);
    while (::waitpid(first, nullptr, 0) < 0 && errno == EINTR) {
    }
    pipe_ = ends[1];
    ::prctl(PR_SET_CHILD_SUBREAPER, 1);
}

ProgramGuard::~ProgramGuard() {
    ::close(pipe_);
    ::munmap(shared_, sizeof(Shared));
}

void ProgramGuard::watch(pid_t group) {
    shared_->group = group;
}

}  // namespace grainsweep::workers
