// How many threads compute one case.
#pragma once

#include <cstdint>

namespace grainsweep::dem::fast {

/// How many threads a case may have.
struct Threads {
    int most = 1;  ///< 0: as many as there are cores
    /// Particles for each of them, at least; with fewer, waiting for one another costs more than it saves.
    std::int32_t least_particles = 4000;
};

}  // namespace grainsweep::dem::fast
