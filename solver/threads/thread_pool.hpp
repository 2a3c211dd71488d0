// Threads that share the parts of one piece of work, again and again.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace grainsweep {

/// As many threads as a piece of work has parts, the calling one among them. Each begins with its own part, which its
/// core's caches know, and goes on with parts that none has begun: where something else keeps the cores busy, the
/// calling thread does alone what the others do not come to do.
class ThreadPool {
public:
    /// At least one; starts one fewer, or as many as the system gives: the parts are as many all the same.
    explicit ThreadPool(int threads);
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;
    ~ThreadPool();

    [[nodiscard]] int size() const { return size_; }
    /// Calls work(k) once for every part k, 0 to size() - 1, on some thread; returns when all have ended. What was
    /// written before, the parts may read; what they write, the caller may read after. The work must not throw.
    template <class Work>
    void run(const Work& work) noexcept {
        begin_and_end(work, false);
    }
    /// As run(), for parts that should end at the same time: see lateness().
    template <class Work>
    void run_compared(const Work& work) noexcept {
        begin_and_end(work, true);
    }
    /// How late each part ended in the rounds of run_compared() since this was called last: 1 always as the last one,
    /// -1 always as the first. Counts rounds in which a part was done by the thread whose own it is. Empty where some
    /// part has fewer than `rounds` of them, which then go on counting.
    [[nodiscard]] std::vector<double> lateness(int rounds);

private:
    /// The round in which a part was last begun, on a cache line of its own.
    struct alignas(64) Part {
        std::atomic<unsigned> begun = 0;
    };
    /// Of compared rounds; written by the part's own thread alone, and by the caller between rounds. A thread may still
    /// be writing when its round has ended.
    struct alignas(64) Order {
        std::atomic<std::int64_t> rounds = 0;
        std::atomic<std::int64_t> ended_before = 0;  ///< parts, summed over them
    };

    template <class Work>
    void begin_and_end(const Work& work, bool compared) noexcept {
        compared_ = compared;
        work_ = [](const void* of, int part) { (*static_cast<const Work*>(of))(part); };
        of_ = &work;
        publish();
        work_on_parts(0, round_.load());
        wait_for_the_rest();
    }

    void serve(int thread) noexcept;
    void publish() noexcept;
    void work_on_parts(int first, unsigned round) noexcept;
    void wait_for_the_rest() noexcept;
    template <class Condition>
    void wait_until(const Condition& holds) noexcept;
    void wake() noexcept;

    int size_;
    bool spins_;  ///< not where threads share cores
    void (*work_)(const void*, int) = nullptr;
    const void* of_ = nullptr;
    bool compared_ = false;
    std::atomic<bool> ends_ = false;
    std::unique_ptr<Part[]> parts_;
    std::unique_ptr<Order[]> orders_;
    alignas(64) std::atomic<unsigned> round_ = 0;
    alignas(64) std::atomic<int> ended_ = 0;   ///< parts of this round
    alignas(64) std::atomic<int> asleep_ = 0;  ///< threads
    std::mutex mutex_;
    std::condition_variable wakes_;
    std::vector<std::jthread> threads_;
};

}  // namespace grainsweep
