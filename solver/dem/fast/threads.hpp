// Number of threads of one case.
#pragma once

#include <cstdint>

namespace grainsweep::dem::fast {

/// Limits of the number of threads of a case.
struct Threads {
    int most = 1;  ///< 0: one per core
    /// Smallest number of particles per thread. With fewer particles, copies of records and waiting cost more than
    /// another thread saves. On cores that begin and end a round within 0.5 us (2 threads) to 2 us (16 threads), 500
    /// particles are still faster.
    std::int32_t least_particles = 500;
};

}  // namespace grainsweep::dem::fast
