#include "sweep/workers/child.hpp"

#include "sweep/files/descriptor.hpp"
#include "sweep/workers/process_start.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <deque>
#include <thread>
#include <utility>

namespace grainsweep::workers {

namespace asio = boost::asio;
using namespace std::chrono_literals;

// ---- the loop --------------------------------------------------------------------------------------------------

struct EventLoop::Impl {
    void await_readable() {
        watched.async_wait(asio::posix::stream_descriptor::wait_read, [this](const boost::system::error_code& error) {
            if (error) return;
            on_readable();
            await_readable();
        });
    }
    ~Impl() {
        if (watched.is_open()) watched.release();  // it belongs to the caller
    }

    asio::io_context io;
    asio::executor_work_guard<asio::io_context::executor_type> work = asio::make_work_guard(io);
    asio::posix::stream_descriptor watched{io};
    std::function<void()> on_readable;
};

EventLoop::EventLoop() : impl_(std::make_unique<Impl>()) {}
EventLoop::~EventLoop() = default;

void EventLoop::run_one_for(std::chrono::milliseconds at_most) {
    impl_->io.run_one_for(at_most);
}

bool EventLoop::poll_one() {
    return impl_->io.poll_one() > 0;
}

void EventLoop::post(std::function<void()> call) {
    asio::post(impl_->io, std::move(call));
}

void EventLoop::on_readable(int descriptor, std::function<void()> call) {
    impl_->watched.assign(descriptor);
    impl_->on_readable = std::move(call);
    impl_->await_readable();
}

// ---- a process -------------------------------------------------------------------------------------------------

namespace {

using files::Descriptor;

constexpr std::size_t kept_log_bytes = 4096;
// Left free when a process is started: databases, artefacts and the like need descriptors too.
constexpr std::size_t spare_descriptors = 32;

class ChildProcess final : public Child, public std::enable_shared_from_this<ChildProcess> {
public:
    ChildProcess(asio::io_context& io, pid_t id, Descriptor in, Descriptor out, Descriptor err)
        : id_(id), in_(io, in.release()), out_(io, out.release()), err_(io, err.release()) {}

    // ---- reading and writing -----------------------------------------------------------------------------

    void listen(Listener listener) override {
        listener_ = std::move(listener);
        await_output();
        await_log();
    }
    void write(std::string line) override {
        outgoing_.push_back(std::move(line));
        if (outgoing_.size() == 1) write_next();
    }
    [[nodiscard]] bool everything_is_written() const override { return outgoing_.empty(); }
    void close() override {
        closed_ = true;
        for (auto* pipe : {&in_, &out_, &err_}) {
            boost::system::error_code ignored;
            pipe->close(ignored);
        }
    }
    /// Returns the log, including the unread part in the pipe.
    [[nodiscard]] const std::string& log() override {
        for (std::size_t rest = 16 * kept_log_bytes; rest > 0 && !closed_;) {
            const auto length = ::read(err_.native_handle(), log_piece_.data(), log_piece_.size());
            if (length <= 0) break;
            keep_log(static_cast<std::size_t>(length));
            rest -= std::min(rest, static_cast<std::size_t>(length));
        }
        return log_;
    }

    // ---- ending: one that cannot even be killed (it waits for a dead file server) is left behind ------------

    void signal(int number) override {
        if (::kill(-id_, number) != 0 && runs()) ::kill(id_, number);  // before it made its own group
    }
    [[nodiscard]] bool runs() override {
        if (ended_) return false;
        const pid_t got = ::waitpid(id_, &status_, WNOHANG);
        ended_ = got == id_ || (got < 0 && errno != EINTR);
        return !ended_;
    }
    void wait(std::chrono::milliseconds at_most) override {
        wait_while([this] { return runs(); }, at_most);
    }
    [[nodiscard]] int status() const override { return status_; }
    [[nodiscard]] std::string end() const override { return describe_end("worker", status_); }
    [[nodiscard]] std::string id() const override { return std::to_string(id_); }
    [[nodiscard]] int process_group() const override { return id_; }

private:
    void await_output() {
        out_.async_read_some(asio::buffer(piece_), [this, self = shared_from_this()](
                                                       const boost::system::error_code& error, std::size_t length) {
            if (closed_) return;
            if (error) return listener_.ended();
            listener_.read({piece_.data(), length});
            if (!closed_) await_output();
        });
    }
    void await_log() {
        err_.async_read_some(asio::buffer(log_piece_), [this, self = shared_from_this()](
                                                           const boost::system::error_code& error, std::size_t length) {
            if (error || closed_) return;
            keep_log(length);
            await_log();
        });
    }
    void keep_log(std::size_t length) {
        log_.append(log_piece_.data(), length);
        if (log_.size() > kept_log_bytes) log_.erase(0, log_.size() - kept_log_bytes);
    }
    void write_next() {
        asio::async_write(in_, asio::buffer(outgoing_.front()),
                          [this, self = shared_from_this()](const boost::system::error_code& error, std::size_t) {
                              if (error || closed_) return;  // its end will be read
                              outgoing_.pop_front();
                              if (!outgoing_.empty()) write_next();
                          });
    }

    pid_t id_;
    asio::posix::stream_descriptor in_, out_, err_;
    int status_ = 1 << 8;  ///< exit code 1, until it is known
    bool ended_ = false, closed_ = false;
    Listener listener_;
    std::array<char, 16384> piece_{};
    std::array<char, 1024> log_piece_{};
    std::string log_;
    std::deque<std::string> outgoing_;
};

}  // namespace

std::shared_ptr<Child> Child::start(EventLoop& loop, const std::vector<std::string>& argv, std::error_code& error) {
    ProcessStart start{argv};
    start.argv.front() = find_program(argv.front());
    if (start.argv.front().empty()) {
        error = std::make_error_code(std::errc::no_such_file_or_directory);
        return nullptr;
    }
    std::array<Descriptor, spare_descriptors> spare;  // taken while pipes are made, so that so many are left
    for (auto& one : spare) one = Descriptor(::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 0));
    std::array<Descriptor, 3> from, to;
    for (std::size_t k = 0; k < 3; ++k) {
        // Our ends must not live on in other workers, or an end of file would never be seen.
        std::array<int, 2> ends{};
        if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
            error.assign(errno, std::system_category());
            return nullptr;
        }
        from[k] = Descriptor(ends[0]);
        to[k] = Descriptor(ends[1]);
    }
    start.streams = {from[0].number(), to[1].number(), to[2].number()};
    const pid_t id = start_process(start, error);
    if (id < 0) return nullptr;
    return std::make_shared<ChildProcess>(loop.impl().io, id, std::move(to[0]), std::move(from[1]), std::move(from[2]));
}

void wait_while(const std::function<bool()>& condition, std::chrono::milliseconds at_most) {
    using Clock = std::chrono::steady_clock;
    const auto until = Clock::now() + at_most;
    for (auto pause = 1ms; condition() && Clock::now() < until;
         pause = std::min<std::chrono::milliseconds>(2 * pause, 50ms))
        std::this_thread::sleep_for(pause);
}

}  // namespace grainsweep::workers
