// Forces of walls computed by all threads of a case, with the same bits as by one thread.
//
// A wall's list is divided between tiles (layout.hpp). The start of a tile depends on the number of earlier particles
// that touch the wall: all threads mark these, then the tiles are counted. The sums over a wall are added tile by tile,
// in order. A wall without sums may be divided anywhere. Walls are computed one after another, so that forces on a
// particle are added in the order of the walls.
#pragma once

#include <cstdint>
#include <vector>

#include "solver/dem/fast/layout.hpp"
#include "solver/dem/fast/subdomains.hpp"
#include "solver/dem/fast/walls.hpp"

namespace grainsweep::dem::fast {

class SharedWalls {
public:
    /// Adds the forces of all walls to those of the particles; writes the sums of each wall.
    void press(const Field& whole, const Kernels& kernels, const Walls& walls, const Subdomains& subdomains,
               Tally& tally);

private:
    [[nodiscard]] bool is_shared(const Field& whole, std::int32_t wall, const Kernels& kernels, int parts) const;
    void find_tiles(const Field& whole, std::int32_t wall, const Kernels& kernels, const Parts& parts);

    std::vector<std::uint16_t> touching_;  ///< lanes of each vector of the list
    std::vector<WallSegment> tiles_;       ///< or, without sums, one share for each part
    std::vector<WallSums> sums_;           ///< of each tile
    std::vector<Tally> tallies_;           ///< of each part
};

}  // namespace grainsweep::dem::fast
