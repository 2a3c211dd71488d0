// Threads that do one piece of work together, again and again: the calling one is number 0.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>
#include <vector>

namespace grainsweep::dem::fast {

/// How many threads a case may have.
struct Threads {
    int most = 1;  ///< 0: as many as there are cores
    /// Particles for each of them, at least; with fewer, waiting for one another costs more than it saves.
    std::int32_t least_particles = 1500;
};

/// Where threads wait for one another. Spins for some microseconds, since on cores of their own all arrive at nearly
/// the same time; then lets other programs run; then sleeps.
class Barrier {
public:
    explicit Barrier(int threads);
    /// Returns when as many calls as there are threads have come. What each thread wrote before, all may read after.
    void meet() noexcept;

private:
    void wait_for_end_of(unsigned round) noexcept;

    int threads_;
    int spins_;  ///< none where threads share cores
    alignas(64) std::atomic<int> arrived_ = 0;
    alignas(64) std::atomic<unsigned> round_ = 0;
};

class ThreadPool {
public:
    /// At least one; starts one fewer.
    explicit ThreadPool(int threads);
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;
    ~ThreadPool();

    [[nodiscard]] int size() const { return size_; }
    /// Calls work(k) on every thread k, 0 to size() - 1; returns when all have ended. The work must not throw.
    template <class Work>
    void run(const Work& work) noexcept {
        work_ = [](const void* of, int thread) { (*static_cast<const Work*>(of))(thread); };
        of_ = &work;
        barrier_.meet();
        work(0);
        barrier_.meet();
    }
    /// Within run(), by every thread: waits for all.
    void meet() noexcept { barrier_.meet(); }

private:
    void serve(int thread) noexcept;

    int size_;
    Barrier barrier_;
    void (*work_)(const void*, int) = nullptr;  ///< null: end
    const void* of_ = nullptr;
    std::vector<std::jthread> threads_;
};

}  // namespace grainsweep::dem::fast
