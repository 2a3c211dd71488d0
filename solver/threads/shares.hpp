// How much of the work each thread should have so that all end at the same time.
//
// Cores are not alike: some are built for less power, some share their arithmetic with another program. Which threads
// end late says so, without a clock. Shares move against it by steps that grow while the direction stays the same and
// shrink when it turns (M. Riedmiller, H. Braun, "A direct adaptive method for faster backpropagation learning: the
// RPROP algorithm", IEEE International Conference on Neural Networks 1993, eq. 5).
#pragma once

#include <span>
#include <vector>

namespace grainsweep {

class Shares {
public:
    /// Equal ones.
    explicit Shares(int parts = 1);

    /// Of the whole work, which is 1.
    [[nodiscard]] double of(int part) const { return share_[static_cast<std::size_t>(part)]; }
    /// `lateness`: of every part, from -1 (it always ended first) to 1 (always last); or empty, then nothing moves.
    /// Shares stay between half of an equal one and twice it, each before they are made to add up to 1.
    void move(std::span<const double> lateness);

private:
    struct Step {
        double size;
        int direction;  ///< of the last one
    };
    std::vector<double> share_;
    std::vector<Step> step_;
};

}  // namespace grainsweep
