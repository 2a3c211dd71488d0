#include "sweep/workers/asking_signals.hpp"

#include <pthread.h>

#include <chrono>

namespace grainsweep::workers {
namespace {

sigset_t asking_set() {
    sigset_t set;
    sigemptyset(&set);
    for (const int signal : asking_signals) sigaddset(&set, signal);
    return set;
}

}  // namespace

void hold_asking_signals() {
    for (const int signal : asking_signals) std::signal(signal, SIG_DFL);  // an ignored one would not be waited for
    const sigset_t set = asking_set();
    ::pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

void attend(const std::function<void(int signal)>& asked, const std::function<void()>& tick) {
    using Clock = std::chrono::steady_clock;
    const sigset_t set = asking_set();
    for (auto until = Clock::now() + std::chrono::seconds(1);;) {
        const auto left = std::chrono::duration_cast<std::chrono::nanoseconds>(until - Clock::now()).count();
        if (left <= 0) {
            until = Clock::now() + std::chrono::seconds(1);
            tick();
            continue;
        }
        const timespec timeout{static_cast<time_t>(left / 1'000'000'000), static_cast<long>(left % 1'000'000'000)};
        if (const int signal = ::sigtimedwait(&set, nullptr, &timeout); signal > 0) asked(signal);
    }
}

}  // namespace grainsweep::workers
