#define BOOST_POSIX_HAS_VFORK 1  // Boost takes it for gone, as it is from POSIX; Linux has it

#include "sweep/workers/process_start.hpp"

#include "sweep/workers/asking_signals.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <boost/process/args.hpp>
#include <boost/process/child.hpp>
#include <boost/process/error.hpp>
#include <boost/process/extend.hpp>
#include <boost/process/posix.hpp>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>

namespace grainsweep::workers {
namespace {

namespace bp = boost::process;

/// No signal reaches this thread while it lives. A process forked meanwhile also begins with all signals blocked. It
/// must not run a handler of this process, which would report the signal here.
class SignalsHeld {
public:
    SignalsHeld() {
        sigset_t all;
        ::sigfillset(&all);
        ::pthread_sigmask(SIG_SETMASK, &all, &before_);
    }
    SignalsHeld(const SignalsHeld&) = delete;
    SignalsHeld& operator=(const SignalsHeld&) = delete;
    ~SignalsHeld() { ::pthread_sigmask(SIG_SETMASK, &before_, nullptr); }

    /// In the new process: every signal does what the system does by itself, or, but in a stranger, stays ignored.
    void give_up_handlers(bool stranger) const {
        for (int number = 1; number < SIGRTMIN; ++number) {
            struct sigaction action {};
            const bool ignored = ::sigaction(number, nullptr, &action) != 0 || action.sa_handler == SIG_IGN;
            if (stranger || !ignored) ::signal(number, SIG_DFL);
        }
        sigset_t none;
        ::sigemptyset(&none);
        ::pthread_sigmask(SIG_SETMASK, stranger ? &none : &before_, nullptr);
    }

private:
    sigset_t before_{};
};

template <class Resource>
void limit(Resource resource, std::optional<std::int64_t> most) {
    if (!most) return;
    const rlimit both{static_cast<rlim_t>(*most), static_cast<rlim_t>(*most)};
    ::setrlimit(resource, &both);
}

/// In the new process, before its program; calls what is allowed after fork(2) only. Returns errno, 0 where all is
/// well.
int become(const ProcessStart& start, const std::array<int, 3>& streams, pid_t parent, const SignalsHeld& held) {
    int failure = 0;
    ::setpgid(0, 0);  // a kill reaches all of the group, the terminal's Ctrl-C only the main program
    for (int k = 0; k < 3; ++k)
        if (::dup2(streams[static_cast<std::size_t>(k)], k) < 0) failure = errno;
    if (start.folder >= 0 && ::fchdir(start.folder) != 0) failure = errno;
    limit(RLIMIT_AS, start.memory);
    limit(RLIMIT_FSIZE, start.file);
    if (start.stranger) {
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (::getppid() != parent) ::_exit(127);
        ::close_range(3, ~0U, 0);
        const rlimit no_core{0, 0};
        ::setrlimit(RLIMIT_CORE, &no_core);
    }
    held.give_up_handlers(start.stranger);
    return failure;
}

/// In the new process, whose program could not be executed: to its log. Calls what is allowed after fork(2) only.
void say_why_not(int number) {
    constexpr std::string_view begin = "it cannot be executed: ";
    const char* reason = ::strerrordesc_np(number);
    const std::string_view end = reason == nullptr ? "unknown error" : reason;
    if (::write(STDERR_FILENO, begin.data(), begin.size()) < 0 || ::write(STDERR_FILENO, end.data(), end.size()) < 0)
        return;
}

/// This process's variables and those given, a later one of a name in the place of an earlier.
std::vector<char*> environment_of(const std::vector<std::string>& given) {
    std::vector<char*> all;
    const auto name_of = [](std::string_view entry) { return entry.substr(0, entry.find('=')); };
    for (char** entry = ::environ; entry != nullptr && *entry != nullptr; ++entry) {
        const auto replaced = [&](const std::string& other) { return name_of(other) == name_of(*entry); };
        if (std::ranges::none_of(given, replaced)) all.push_back(*entry);
    }
    for (const auto& entry : given) all.push_back(const_cast<char*>(entry.c_str()));
    all.push_back(nullptr);
    return all;
}

bool may_be_executed(const std::string& path) {
    struct stat status {};
    return ::stat(path.c_str(), &status) == 0 && S_ISREG(status.st_mode) && ::access(path.c_str(), X_OK) == 0;
}

}  // namespace

pid_t start_process(const ProcessStart& start, std::error_code& error) {
    static const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
    auto streams = start.streams;
    std::ranges::replace_if(
        streams, [](int stream) { return stream < 0; }, nothing);
    auto environment = environment_of(start.environment);
    const pid_t parent = ::getpid();
    volatile int failure = 0;  // errno; a stranger shares the memory until its program runs
    const SignalsHeld held;
    const auto set_up = [&](auto& executor) { executor.env = environment.data(); };
    const auto prepare = [&](auto&) {
        failure = become(start, streams, parent, held);
        if (failure != 0) ::_exit(127);
    };
    const auto give_up = [&](auto&, const std::error_code& refused) {
        failure = refused.value();
        if (!start.stranger) say_why_not(refused.value());
    };
    const auto begin = [&](const auto&... way) {  // Boost finds use_vfork by its reference
        const boost::filesystem::path program(start.argv.front());
        const auto arguments = bp::args(std::vector<std::string>(start.argv.begin() + 1, start.argv.end()));
        return bp::child(program, arguments, bp::extend::on_setup = set_up, bp::extend::on_exec_setup = prepare,
                         bp::extend::on_exec_error = give_up, bp::ignore_error, way...);
    };
    auto child = start.stranger ? begin(bp::posix::use_vfork) : begin();
    const pid_t id = child.valid() ? child.id() : -1;
    child.detach();  // waited for by its number
    if (id > 0 && failure != 0) {
        while (::waitpid(id, nullptr, 0) < 0 && errno == EINTR) {
        }
        error.assign(failure, std::system_category());
        return -1;
    }
    if (id < 0) error = std::make_error_code(std::errc::resource_unavailable_try_again);
    return id;
}

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

int ending_signal(int status) {
    if (WIFSIGNALED(status)) return WTERMSIG(status);
    return WEXITSTATUS(status) > 128 ? WEXITSTATUS(status) - 128 : 0;
}

bool ended_from_outside(int status, std::string_view log) {
    return std::ranges::find(asking_signals, ending_signal(status)) != asking_signals.end() ||
           log.find(" CANCELLED AT ") != std::string_view::npos ||
           log.find("Node failure on ") != std::string_view::npos;
}

std::string describe_end(std::string_view what, int status) {
    if (WIFSIGNALED(status))
        return fmt::format("{} ended by signal {} ({})", what, WTERMSIG(status), ::strsignal(WTERMSIG(status)));
    return fmt::format("{} ended with exit code {}", what, WEXITSTATUS(status));
}

}  // namespace grainsweep::workers
