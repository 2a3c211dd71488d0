// Pool of threads that share the parts of one piece of work, repeatedly.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace grainsweep {

/// Pool with one thread per part, including the calling thread. Each thread begins with its own part, whose data is in
/// its core's caches, and continues with parts that no thread has begun. If other programs use the cores, the calling
/// thread does the parts of delayed threads.
class ThreadPool {
public:
    /// `threads`: at least one. Starts one fewer, or as many as the system permits; the number of parts does not
    /// change.
    explicit ThreadPool(int threads);
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;
    ~ThreadPool();

    [[nodiscard]] int size() const { return size_; }
    /// Calls work(k) once for every part k, 0 to size() - 1, on some thread; returns when all have ended. The parts see
    /// all earlier writes of the caller, and the caller sees all writes of the parts. The work must not throw.
    template <class Work>
    void run(const Work& work) noexcept {
        begin_and_end(work, false);
    }
    /// Does the same as run() and measures the times of the parts: see seconds().
    template <class Work>
    void run_timed(const Work& work) noexcept {
        begun_at_ = clock_seconds();
        ++timed_rounds_;
        begin_and_end(work, true);
    }
    /// Returns the mean seconds from the beginning of a round of run_timed() to the end of each part. It is the
    /// geometric mean, which reduces the weight of interrupted rounds. Only rounds in which a part was done by its own
    /// thread count. Empty if a part has fewer than `rounds` such rounds.
    [[nodiscard]] std::vector<double> seconds(std::int64_t rounds) const;
    /// Returns the rounds of run_timed() since forget_times().
    [[nodiscard]] std::int64_t timed_rounds() const { return timed_rounds_; }
    void forget_times();
    /// Returns the seconds of a monotonic clock. Times affect the division of work between threads, but not its
    /// results.
    [[nodiscard]] static double clock_seconds();

private:
    /// Last round in which a part was begun, on a cache line of its own.
    struct alignas(64) Part {
        std::atomic<unsigned> begun = 0;
    };
    /// Times of a part; written by the part's own thread during a round, and by the caller between rounds.
    struct alignas(64) Times {
        std::int64_t rounds = 0;
        double logarithms = 0;  ///< sum of the logarithms of seconds
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
    bool spins_;  ///< false if threads share cores
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
