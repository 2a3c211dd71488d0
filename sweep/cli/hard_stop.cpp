#include "sweep/cli/hard_stop.hpp"

#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <csignal>

namespace grainsweep::cli {
namespace {

constexpr double grace_seconds = 0.5, longest = 1e9;

// Returns the text that a signal handler writes.
std::string& last_words() {
    static std::string words;
    return words;
}

void end_here(int) {
    const auto& words = last_words();
    (void)!::write(STDERR_FILENO, words.data(), words.size());
    ::_exit(2);
}

void set_timer(double seconds) {
    const double whole = std::floor(seconds);
    itimerval timer{};
    timer.it_value.tv_sec = static_cast<time_t>(whole);
    timer.it_value.tv_usec = static_cast<suseconds_t>(1e6 * (seconds - whole));
    ::setitimer(ITIMER_PROF, &timer, nullptr);  // processor time of the whole process
}

}  // namespace

HardStop::HardStop(double seconds, const std::string& sentence) {
    if (!(seconds > 0)) return;
    last_words() = "grainsweep: " + sentence + "\n";
    std::signal(SIGPROF, end_here);
    set_timer(std::min(seconds + grace_seconds, longest));
}

HardStop::~HardStop() {
    set_timer(0);
}

}  // namespace grainsweep::cli
