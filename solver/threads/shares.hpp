// How much of the work each thread should have so that all end at the same time.
//
// Cores are not alike: some are built for less power, some share their arithmetic with another program or with another
// thread of this one. A thread that took t where all took t' on average gets (t'/t)^0.7 of its share: less than all of
// the difference, because times scatter and part of them does not depend on the share.
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
    /// `seconds`: that each part took; or empty, then nothing moves. Shares stay between half of an equal one and twice
    /// it, each before they are made to add up to 1.
    void move(std::span<const double> seconds);

private:
    std::vector<double> share_;
};

}  // namespace grainsweep
