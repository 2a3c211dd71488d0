#include "sweep/workers/child.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>
#include <boost/process/extend.hpp>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <thread>

namespace grainsweep::workers {
namespace {

namespace asio = boost::asio;
namespace bp = boost::process;
using namespace std::chrono_literals;

constexpr std::size_t kept_log_bytes = 4096;
// Left free when a process is started: databases, artefacts and the like need descriptors too.
constexpr std::size_t spare_descriptors = 32;

/// Our ends of a pipe must not live on in other workers, or an end of file would never be seen.
void close_on_exec(bp::async_pipe& pipe) {
    for (const int fd : {pipe.native_source(), pipe.native_sink()}) ::fcntl(fd, F_SETFD, FD_CLOEXEC);
}

/// Takes some descriptors away while it lives, so that what is opened then leaves so many free.
class SpareDescriptors {
public:
    SpareDescriptors() {
        for (int& fd : held_) fd = ::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 0);
    }
    SpareDescriptors(const SpareDescriptors&) = delete;
    SpareDescriptors& operator=(const SpareDescriptors&) = delete;
    ~SpareDescriptors() {
        for (const int fd : held_)
            if (fd >= 0) ::close(fd);
    }

private:
    std::array<int, spare_descriptors> held_{};
};

/// No signal reaches this thread while it lives. A process that is forked then begins with all of them held, too, and
/// must not answer one by a handler of ours, which would tell this process of it.
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

    /// In the new process: every signal does what the system does by itself, or stays ignored.
    void give_up_handlers() const {
        for (int number = 1; number < SIGRTMIN; ++number) {
            struct sigaction action {};
            if (::sigaction(number, nullptr, &action) != 0 || action.sa_handler == SIG_IGN) continue;
            ::signal(number, SIG_DFL);
        }
        ::pthread_sigmask(SIG_SETMASK, &before_, nullptr);
    }

private:
    sigset_t before_{};
};

boost::filesystem::path program_of(const std::string& word) {
    if (word.find('/') == std::string::npos) return bp::search_path(word);
    boost::system::error_code error;
    const bool there = boost::filesystem::is_regular_file(word, error) && ::access(word.c_str(), X_OK) == 0;
    return there ? boost::filesystem::path(word) : boost::filesystem::path();
}

/// In the new process, whose program could not be executed: to its log. Calls what is allowed after fork(2) only.
void say_why_not(int number) {
    constexpr std::string_view begin = "it cannot be executed: ";
    const char* reason = ::strerrordesc_np(number);
    const std::string_view end = reason == nullptr ? "unknown error" : reason;
    if (::write(STDERR_FILENO, begin.data(), begin.size()) < 0 || ::write(STDERR_FILENO, end.data(), end.size()) < 0)
        return;
}

}  // namespace

std::shared_ptr<Child> Child::start(asio::io_context& io, const std::vector<std::string>& argv,
                                    std::error_code& error) {
    const auto executable = program_of(argv.front());
    if (executable.empty()) {
        error = std::make_error_code(std::errc::no_such_file_or_directory);
        return nullptr;
    }
    try {
        const SpareDescriptors spare;
        auto child = std::make_shared<Child>(io);
        for (auto* pipe : {&child->in_, &child->out_, &child->err_}) close_on_exec(*pipe);
        const SignalsHeld held;
        child->process_ = bp::child(
            executable, bp::args(std::vector<std::string>(argv.begin() + 1, argv.end())),
            bp::std_in<child->in_, bp::std_out> child->out_, bp::std_err > child->err_,
            bp::ignore_error,  // else it is waited for until its program is loaded, from a dead file server for ever
            // a kill reaches all of the group, the terminal's Ctrl-C only the main program
            bp::extend::on_exec_setup =
                [&held](auto&) {
                    ::setpgid(0, 0);
                    held.give_up_handlers();
                },
            bp::extend::on_exec_error = [](auto&, const std::error_code& refused) { say_why_not(refused.value()); });
        child->id_ = child->process_.id();
        if (child->process_.valid()) return child;
        error = std::make_error_code(std::errc::resource_unavailable_try_again);
        return nullptr;
    } catch (const std::system_error& failure) {  // no descriptors left, say
        error = failure.code();
        return nullptr;
    }
}

bool Child::can_start(const std::string& program) {
    return !program_of(program).empty();
}

// One that cannot even be killed (it waits for a dead file server) is left behind.
Child::~Child() {
    process_.detach();
}

// ---- reading and writing ---------------------------------------------------------------------------------------

void Child::listen(Listener listener) {
    listener_ = std::move(listener);
    await_output();
    await_log();
}

void Child::await_output() {
    out_.async_read_some(asio::buffer(piece_),
                         [this, self = shared_from_this()](const boost::system::error_code& error, std::size_t length) {
                             if (closed_) return;
                             if (error) return listener_.ended();
                             listener_.read({piece_.data(), length});
                             if (!closed_) await_output();
                         });
}

void Child::await_log() {
    err_.async_read_some(asio::buffer(log_piece_),
                         [this, self = shared_from_this()](const boost::system::error_code& error, std::size_t length) {
                             if (error || closed_) return;
                             keep_log(length);
                             await_log();
                         });
}

void Child::keep_log(std::size_t length) {
    log_.append(log_piece_.data(), length);
    if (log_.size() > kept_log_bytes) log_.erase(0, log_.size() - kept_log_bytes);
}

const std::string& Child::log() {
    for (std::size_t rest = 16 * kept_log_bytes; rest > 0 && !closed_;) {
        const auto length = ::read(err_.native_source(), log_piece_.data(), log_piece_.size());
        if (length <= 0) break;
        keep_log(static_cast<std::size_t>(length));
        rest -= std::min(rest, static_cast<std::size_t>(length));
    }
    return log_;
}

void Child::write(std::string line) {
    outgoing_.push_back(std::move(line));
    if (outgoing_.size() == 1) write_next();
}

void Child::write_next() {
    asio::async_write(in_, asio::buffer(outgoing_.front()),
                      [this, self = shared_from_this()](const boost::system::error_code& error, std::size_t) {
                          if (error || closed_) return;  // its end will be read
                          outgoing_.pop_front();
                          if (!outgoing_.empty()) write_next();
                      });
}

void Child::close() {
    closed_ = true;
    for (auto* pipe : {&in_, &out_, &err_}) {
        boost::system::error_code ignored;
        pipe->close(ignored);
    }
}

// ---- ending ----------------------------------------------------------------------------------------------------

void Child::signal(int number) {
    if (id_ > 0 && ::kill(-id_, number) != 0 && runs()) ::kill(id_, number);  // before it made its own group
}

bool Child::runs() {
    std::error_code ignored;
    return process_.running(ignored);
}

void Child::wait(std::chrono::milliseconds at_most) {
    wait_while([this] { return runs(); }, at_most);
}

std::string Child::end() const {
    return describe_end("worker", status());
}

void wait_while(const std::function<bool()>& condition, std::chrono::milliseconds at_most) {
    using Clock = std::chrono::steady_clock;
    const auto until = Clock::now() + at_most;
    for (auto pause = 1ms; condition() && Clock::now() < until;
         pause = std::min<std::chrono::milliseconds>(2 * pause, 50ms))
        std::this_thread::sleep_for(pause);
}

int ending_signal(int status) {
    if (WIFSIGNALED(status)) return WTERMSIG(status);
    return WEXITSTATUS(status) > 128 ? WEXITSTATUS(status) - 128 : 0;
}

bool ended_from_outside(int status, std::string_view log) {
    const int signal = ending_signal(status);
    for (const int asking : {SIGTERM, SIGINT, SIGHUP, SIGUSR1, SIGUSR2})
        if (signal == asking) return true;
    return log.find(" CANCELLED AT ") != std::string_view::npos ||
           log.find("Node failure on ") != std::string_view::npos;
}

std::string describe_end(std::string_view what, int status) {
    if (WIFSIGNALED(status))
        return fmt::format("{} ended by signal {} ({})", what, WTERMSIG(status), ::strsignal(WTERMSIG(status)));
    return fmt::format("{} ended with exit code {}", what, WEXITSTATUS(status));
}

}  // namespace grainsweep::workers
