// Shares of the work of each thread, so that all threads end at the same time.
//
// Cores differ: some are built for less power, some share their arithmetic units with another program or thread. A
// thread that needs the time t, while the average is t', gets (t'/t)^0.7 times its share. The exponent is below 1
// because times scatter and a part of them does not depend on the share.
#pragma once

#include <span>
#include <vector>

namespace grainsweep {

class Shares {
public:
    /// Makes equal shares.
    explicit Shares(int parts = 1);

    /// Returns the share of a part; the whole work is 1.
    [[nodiscard]] double of(int part) const { return share_[static_cast<std::size_t>(part)]; }
    /// Adapts the shares. `seconds`: time of each part; empty: no change. Each share is limited to between half and
    /// twice an equal share; then all are scaled to add to 1.
    void move(std::span<const double> seconds);

private:
    std::vector<double> share_;
};

}  // namespace grainsweep
