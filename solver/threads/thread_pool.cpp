#include "solver/threads/thread_pool.hpp"

#include "solver/own_cores.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <system_error>

namespace grainsweep {

namespace {

// Looks at a condition while awake: half a millisecond or more, longer than the serial part of most steps takes.
// Yielding the core instead would cost the rest of a time slice if another program uses it; a thread that slept is
// resumed at once.
constexpr int patience = 20000;
constexpr int moment = 100;  ///< looks; a few microseconds

void pause_core() {
#if defined(__x86_64__)
    __builtin_ia32_pause();
#elif defined(__aarch64__)
    asm volatile("yield");
#endif
}

}  // namespace

ThreadPool::ThreadPool(int threads)
    : size_(threads),
      spins_(threads <= own_cores()),
      parts_(std::make_unique<Part[]>(static_cast<std::size_t>(threads))),
      times_(std::make_unique<Times[]>(static_cast<std::size_t>(threads))) {
    threads_.reserve(static_cast<std::size_t>(threads));
    try {
        for (int k = 1; k < threads; ++k) threads_.emplace_back([this, k] { serve(k); });
    } catch (const std::system_error&) {  // the system gives no more: those that there are do all parts
    }
}

ThreadPool::~ThreadPool() {
    ends_ = true;
    round_.fetch_add(1);
    wake();
}

void ThreadPool::serve(int thread) noexcept {
    unsigned round = 0;
    while (!ends_) {
        wait_until([&] { return round_.load() != round; });
        round = round_.load();
        if (!ends_) work_on_parts(thread, round);
    }
}

void ThreadPool::publish() noexcept {
    ended_.store(0, std::memory_order_relaxed);
    round_.fetch_add(1);
    wake();
}

/// Each thread begins with its own part, and searches for other parts only if the round does not end soon, because a
/// search costs messages between all cores.
void ThreadPool::work_on_parts(int first, unsigned round) noexcept {
    const auto over = [&] { return first == 0 ? all_ended() : round_.load() != round; };
    work_on(first, first, round);
    for (int k = 0; spins_ && k < moment && !over(); ++k) pause_core();
    for (int k = 1; k < size_ && !over(); ++k) work_on((first + k) % size_, first, round);
}

/// A part is begun by the thread that moves it from the round before to this one. All parts of a round are begun before
/// the round ends, so a late thread with the number of an old round finds none.
void ThreadPool::work_on(int part, int thread, unsigned round) noexcept {
    auto& begun = parts_[static_cast<std::size_t>(part)].begun;
    unsigned before = round - 1;
    if (begun.load() != before || !begun.compare_exchange_strong(before, round)) return;
    work_(of_, part);
    if (timed_ && part == thread) {
        Times& times = times_[static_cast<std::size_t>(part)];
        ++times.rounds;
        times.logarithms += std::log(std::max(clock_seconds() - begun_at_, 1e-9));
    }
    if (ended_.fetch_add(1) + 1 == size_ && thread != 0) wake();
}

std::vector<double> ThreadPool::seconds(std::int64_t rounds) const {
    std::vector<double> seconds;
    for (int k = 0; k < size_; ++k) {
        const Times& times = times_[static_cast<std::size_t>(k)];
        if (times.rounds < std::max<std::int64_t>(rounds, 1)) return {};
        seconds.push_back(std::exp(times.logarithms / static_cast<double>(times.rounds)));
    }
    return seconds;
}

double ThreadPool::clock_seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void ThreadPool::forget_times() {
    timed_rounds_ = 0;
    for (int k = 0; k < size_; ++k) times_[static_cast<std::size_t>(k)] = {};
}

void ThreadPool::wait_for_the_rest() noexcept {
    wait_until([this] { return all_ended(); });
}

/// Conditions change by sequentially consistent writes, after which wake() is called: it sees a thread that sleeps,
/// or one that falls asleep sees the change.
template <class Condition>
void ThreadPool::wait_until(const Condition& holds) noexcept {
    for (int k = 0; k < (spins_ ? patience : 64); ++k) {
        if (holds()) return;
        pause_core();
    }
    std::unique_lock lock(mutex_);
    asleep_.fetch_add(1);
    wakes_.wait(lock, holds);
    asleep_.fetch_sub(1);
}

void ThreadPool::wake() noexcept {
    if (asleep_.load() == 0) return;
    const std::lock_guard lock(mutex_);
    wakes_.notify_all();
}

}  // namespace grainsweep
