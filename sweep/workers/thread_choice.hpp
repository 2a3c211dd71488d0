// How many of the threads that a case may have it uses.
#pragma once

#include <array>
#include <cstddef>

namespace grainsweep::workers {

/// Chooses between all threads, half of them and one by their speed in trial slices. Fewer threads are faster where
/// other programs keep the cores busy, where the cores are far from one another, or where a case has few particles. The
/// trials are repeated every 64 slices, and where the case may have twice or half as many threads as at the last ones.
/// No bit of a result depends on the choice.
class ThreadChoice {
public:
    /// Threads of the next slice.
    [[nodiscard]] int next(int allowed);
    /// Counts a slice: its work, in any unit, and its seconds.
    void note(double work, double seconds);

private:
    enum Candidate : std::size_t { all, half, one, candidates };
    /// What is tried in the first slices.
    static constexpr std::array<Candidate, 4> trials = {all, all, half, one};
    static constexpr std::size_t period = 64;

    int allowed_ = 1, allowed_in_trials_ = 1;
    std::size_t slices_ = 0;  ///< since the trials began
    Candidate chosen_ = all;
    std::array<double, candidates> rate_{};
};

}  // namespace grainsweep::workers
