// How many of the threads that a case may have it uses.
#pragma once

#include <array>
#include <cstddef>

namespace grainsweep::workers {

/// Chooses between all threads, half of them and one by their speed in trial slices. Fewer threads are faster where
/// other programs keep the cores busy, where the cores are far from one another, or where a case has few particles. The
/// trials are repeated every 64 slices. No bit of a result depends on the choice.
class ThreadChoice {
public:
    /// Threads of the next slice.
    [[nodiscard]] int next(int allowed);
    /// Counts a slice: its work, in any unit, and its seconds.
    void note(double work, double seconds);

private:
    static constexpr int trials = 2, period = 64;  ///< slices
    static constexpr std::size_t candidates = 3;

    [[nodiscard]] int threads_of(std::size_t candidate) const;

    int allowed_ = 1;
    int timed_ = 0;           ///< slices since the trials began
    std::size_t chosen_ = 0;  ///< candidate
    std::array<double, candidates> rate_{};
};

}  // namespace grainsweep::workers
