// A worker's process and its three pipes: started, written to, read from, signalled, waited for. Nothing here knows
// what is written or why it ends; the pool does.
#pragma once

#include "sweep/workers/process.hpp"

#include <utility>  // Boost 1.74's Asio needs it first under C++20

#include <boost/asio.hpp>
#include <boost/process.hpp>

#include <array>
#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace grainsweep::workers {

class Child final : public Process, public std::enable_shared_from_this<Child> {
public:
    /// nullptr, and why in `error`, where there is no program of that name, or no descriptor, memory or process to be
    /// had. Does not wait until the program is loaded: one that cannot be executed ends at once and says so in its log.
    /// The process is the head of a group of its own: the terminal's Ctrl-C does not reach it.
    [[nodiscard]] static std::shared_ptr<Child> start(boost::asio::io_context& io, const std::vector<std::string>& argv,
                                                      std::error_code& error);
    /// Whether there is such a program, on the search path where the word is no path.
    [[nodiscard]] static bool can_start(const std::string& program);

    explicit Child(boost::asio::io_context& io) : in_(io), out_(io), err_(io) {}
    ~Child() override;

    void listen(Listener listener) override;
    void write(std::string line) override;
    [[nodiscard]] bool everything_is_written() const override { return outgoing_.empty(); }
    void close() override;

    void signal(int number) override;
    [[nodiscard]] bool runs() override;
    void wait(std::chrono::milliseconds at_most) override;
    [[nodiscard]] int status() const override { return process_.native_exit_code(); }
    [[nodiscard]] std::string end() const override;
    [[nodiscard]] std::string id() const override { return std::to_string(id_); }
    [[nodiscard]] int process_group() const { return id_; }
    /// Including what stands in the pipe.
    [[nodiscard]] const std::string& log() override;

private:
    void await_output();
    void await_log();
    void write_next();
    void keep_log(std::size_t length);

    boost::process::child process_;
    boost::process::async_pipe in_, out_, err_;
    int id_ = -1;
    bool closed_ = false;
    Listener listener_;
    std::array<char, 16384> piece_{};
    std::array<char, 1024> log_piece_{};
    std::string log_;
    std::deque<std::string> outgoing_;
};

/// Calls until `condition` no longer holds, or for so long, with growing pauses.
void wait_while(const std::function<bool()>& condition, std::chrono::milliseconds at_most);

// What the status of a process that ended says.
/// The signal that ended it, also where a launcher or a shell reports it by an exit code; 0: none.
[[nodiscard]] int ending_signal(int status);
/// Whether it was ended by something else than what it computed: by a signal that asks, or by Slurm, which says in the
/// log where it ends a step for its time limit, a pre-emption or a failed node.
[[nodiscard]] bool ended_from_outside(int status, std::string_view log);
/// "worker ended by signal 9 (Killed)".
[[nodiscard]] std::string describe_end(std::string_view what, int status);

}  // namespace grainsweep::workers
