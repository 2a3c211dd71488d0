#include "solver/threads/thread_pool.hpp"

#include "solver/own_cores.hpp"

#include <system_error>

namespace grainsweep {

namespace {

// Looks at a condition while awake: half a millisecond or more, longer than the serial part of most steps takes. Giving
// the core away instead would cost the rest of a time slice wherever something else wants it; a thread that slept is
// resumed at once.
constexpr int patience = 20000;

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
      orders_(std::make_unique<Order[]>(static_cast<std::size_t>(threads))) {
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

/// A part is begun by the thread that moves it from the round before to this one. All parts of a round are begun
/// before the round ends: a thread that comes too late, with the number of an old round, finds none.
void ThreadPool::work_on_parts(int first, unsigned round) noexcept {
    for (int k = 0; k < size_; ++k) {
        const int part = (first + k) % size_;
        unsigned before = round - 1;
        if (!parts_[static_cast<std::size_t>(part)].begun.compare_exchange_strong(before, round)) continue;
        const bool compared = compared_ && k == 0;
        work_(of_, part);
        const int ended_before = ended_.fetch_add(1);
        if (ended_before + 1 == size_ && first != 0) wake();
        if (compared) {
            Order& order = orders_[static_cast<std::size_t>(part)];
            order.rounds.fetch_add(1, std::memory_order_relaxed);
            order.ended_before.fetch_add(ended_before, std::memory_order_relaxed);
        }
    }
}

std::vector<double> ThreadPool::lateness(int rounds) {
    const auto all = static_cast<std::size_t>(size_);
    for (std::size_t k = 0; k < all; ++k)
        if (orders_[k].rounds.load(std::memory_order_relaxed) < rounds) return {};
    std::vector<double> late(all);
    for (std::size_t k = 0; k < all; ++k) {
        const auto counted = static_cast<double>(orders_[k].rounds.exchange(0, std::memory_order_relaxed));
        const auto before = static_cast<double>(orders_[k].ended_before.exchange(0, std::memory_order_relaxed));
        late[k] = all > 1 ? 2 * before / (counted * static_cast<double>(all - 1)) - 1 : 0;
    }
    return late;
}

void ThreadPool::wait_for_the_rest() noexcept {
    wait_until([&] { return ended_.load() == size_; });
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
