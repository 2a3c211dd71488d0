#include "solver/dem/fast/thread_pool.hpp"

#include <chrono>

namespace grainsweep::dem::fast {

namespace {

constexpr int most_spins = 2000;  // about 20 us
constexpr std::chrono::milliseconds patience{1};

void pause_core() {
#if defined(__x86_64__)
    __builtin_ia32_pause();
#elif defined(__aarch64__)
    asm volatile("yield");
#endif
}

}  // namespace

Barrier::Barrier(int threads)
    : threads_(threads), spins_(threads <= static_cast<int>(std::thread::hardware_concurrency()) ? most_spins : 0) {}

void Barrier::meet() noexcept {
    const unsigned round = round_.load(std::memory_order_relaxed);
    if (arrived_.fetch_add(1, std::memory_order_acq_rel) + 1 < threads_) {
        wait_for_end_of(round);
        return;
    }
    arrived_.store(0, std::memory_order_relaxed);
    round_.store(round + 1, std::memory_order_release);
    round_.notify_all();
}

void Barrier::wait_for_end_of(unsigned round) noexcept {
    const auto ended = [&] { return round_.load(std::memory_order_acquire) != round; };
    for (int k = 0; k < spins_; ++k) {
        if (ended()) return;
        pause_core();
    }
    const auto start = std::chrono::steady_clock::now();
    while (std::chrono::steady_clock::now() - start < patience) {
        if (ended()) return;
        std::this_thread::yield();
    }
    while (!ended()) round_.wait(round, std::memory_order_acquire);
}

ThreadPool::ThreadPool(int threads) : size_(threads), barrier_(threads) {
    threads_.reserve(static_cast<std::size_t>(threads));
    for (int k = 1; k < threads; ++k) threads_.emplace_back([this, k] { serve(k); });
}

ThreadPool::~ThreadPool() {
    work_ = nullptr;
    if (size_ > 1) barrier_.meet();
}

void ThreadPool::serve(int thread) noexcept {
    for (;;) {
        barrier_.meet();
        if (work_ == nullptr) return;
        work_(of_, thread);
        barrier_.meet();
    }
}

}  // namespace grainsweep::dem::fast
