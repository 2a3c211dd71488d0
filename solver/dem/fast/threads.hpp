// How many threads compute one case.
#pragma once

#include <cstdint>

namespace grainsweep::dem::fast {

/// How many threads a case may have.
struct Threads {
    int most = 1;  ///< 0: as many as there are cores
    /// Particles for each of them, at least: with fewer, the copies of one another's particles and waiting cost more
    /// than another thread saves. On cores that begin and end a round within 0.5 us (2 threads) to 2 us (16), 500 still
    /// gain.
    std::int32_t least_particles = 500;
};

}  // namespace grainsweep::dem::fast
