#include "sweep/workers/end_requests.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <string_view>

namespace grainsweep::workers {
namespace {

constexpr std::array signals_answered = {SIGINT, SIGTERM, SIGUSR1};

// Written by the handler, which may call little.
std::atomic<int> attending = 0, requested = 0;
std::array<int, 2> pipe_ends = {-1, -1};

constexpr int exit_code_of(int signal) {
    return signal == SIGINT ? 130 : 75;
}

void note_signal(int signal) {
    const int before = errno;
    if (attending > 0) {
        const auto byte = static_cast<unsigned char>(signal);
        (void)!::write(pipe_ends[1], &byte, 1);
        errno = before;
        return;
    }
    constexpr std::string_view interrupted = "grainsweep: interrupted; run again to resume\n",
                               ended = "grainsweep: ended by a signal; run again to resume\n";
    const auto words = signal == SIGINT ? interrupted : ended;
    (void)!::write(STDERR_FILENO, words.data(), words.size());
    ::_exit(exit_code_of(signal));
}

}  // namespace

void answer_end_requests() {
    if (pipe_ends[0] < 0 && ::pipe2(pipe_ends.data(), O_CLOEXEC | O_NONBLOCK) != 0) return;
    struct sigaction action {};
    action.sa_handler = note_signal;
    action.sa_flags = SA_RESTART;
    sigemptyset(&action.sa_mask);
    for (const int signal : signals_answered) ::sigaction(signal, &action, nullptr);
}

std::optional<int> requested_end() {
    const int signal = requested;
    return signal == 0 ? std::nullopt : std::optional(exit_code_of(signal));
}

EndRequests::EndRequests() {
    answer_end_requests();
    ++attending;
}

EndRequests::~EndRequests() {
    --attending;
    while (next()) {  // a request that came too late for the pool
    }
}

int EndRequests::descriptor() const {
    return pipe_ends[0];
}

std::optional<int> EndRequests::next() {
    unsigned char byte = 0;
    if (::read(pipe_ends[0], &byte, 1) != 1) return std::nullopt;
    requested = byte;
    return byte;
}

}  // namespace grainsweep::workers
