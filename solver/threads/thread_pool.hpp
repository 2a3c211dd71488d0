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
    /// As run(), for parts that should end at the same time: see seconds().
    template <class Work>
    void run_timed(const Work& work) noexcept {
        begun_at_ = clock_seconds();
        ++timed_rounds_;
        begin_and_end(work, true);
    }
    /// Seconds from the beginning of a round of run_timed() to the end of each part: the geometric mean, on which a
    /// round that the system interrupts has little weight, of the rounds in which the thread whose own the part is did
    /// it. Empty where some part has fewer than `rounds` of them.
    [[nodiscard]] std::vector<double> seconds(std::int64_t rounds) const;
    /// Rounds of run_timed() since forget_times().
    [[nodiscard]] std::int64_t timed_rounds() const { return timed_rounds_; }
    void forget_times();
    /// Of a clock that only goes forward. Times decide which thread computes what, never what is computed.
    [[nodiscard]] static double clock_seconds();

private:
    /// The round in which a part was last begun, on a cache line of its own.
    struct alignas(64) Part {
        std::atomic<unsigned> begun = 0;
    };
    /// Of timed rounds; written by the part's own thread during a round, and by the caller between rounds.
    struct alignas(64) Times {
        std::int64_t rounds = 0;
        double logarithms = 0;  ///< of seconds, their sum
    };

    template <class Work>
    void begin_and_end(const Work& work, bool timed) noexcept {
        timed_ = timed;
        work_ = [](const void* of, int part) { (*static_cast<const Work*>(of))(part); };
        of_ = &work;
        publish();
        work_on_parts(0, round_.load());
        wait_for_the_rest();
    }

    void serve(int thread) noexcept;
    void publish() noexcept;
    void work_on_parts(int first, unsigned round) noexcept;
    void work_on(int part, int thread, unsigned round) noexcept;
    void wait_for_the_rest() noexcept;
    [[nodiscard]] bool all_ended() const noexcept { return ended_.load() == size_; }
    template <class Condition>
    void wait_until(const Condition& holds) noexcept;
    void wake() noexcept;

    int size_;
    bool spins_;  ///< not where threads share cores
    void (*work_)(const void*, int) = nullptr;
    const void* of_ = nullptr;
    bool timed_ = false;
    double begun_at_ = 0;
    std::int64_t timed_rounds_ = 0;
    std::atomic<bool> ends_ = false;
    std::unique_ptr<Part[]> parts_;
    std::unique_ptr<Times[]> times_;
    alignas(64) std::atomic<unsigned> round_ = 0;
    alignas(64) std::atomic<int> ended_ = 0;   ///< parts of this round
    alignas(64) std::atomic<int> asleep_ = 0;  ///< threads
    std::mutex mutex_;
    std::condition_variable wakes_;
    std::vector<std::jthread> threads_;
};

}  // namespace grainsweep
