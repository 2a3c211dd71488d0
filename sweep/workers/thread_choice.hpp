// Number of threads that a case uses, out of those it may use.
#pragma once

#include <array>
#include <cstddef>

namespace grainsweep::workers {

/// Chooser between all threads, half of them, and one, by their speed in trial slices. Fewer threads are faster if
/// other programs use the cores, if the cores are far from one another, or if a case has few particles. The trials are
/// repeated every 64 slices, and when the permitted number has doubled or halved since the last trials. Results have
/// the same bits for any choice.
class ThreadChoice {
public:
    /// Returns the threads of the next slice.
    [[nodiscard]] int next(int allowed);
    /// Counts a slice: its work, in any unit, and its seconds.
    void note(double work, double seconds);

private:
    enum Candidate : std::size_t { all, half, one, candidates };
    /// Candidates of the first slices.
    static constexpr std::array<Candidate, 4> trials = {all, all, half, one};
    static constexpr std::size_t period = 64;

    int allowed_ = 1, allowed_in_trials_ = 1;
    std::size_t slices_ = 0;  ///< slices since the trials began
    Candidate chosen_ = all;
    std::array<double, candidates> rate_{};
};

}  // namespace grainsweep::workers
