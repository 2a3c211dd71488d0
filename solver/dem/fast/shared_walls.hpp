// Forces of walls by all threads of a case, with the bits of one.
//
// A wall's list is cut between tiles (layout.hpp). Where these begin depends on how many particles touch the wall
// before them: all threads mark which do, then the tiles are counted through. The sums over a wall are added up tile by
// tile, in their order. A wall that is not summed up may be cut anywhere. Walls follow one another, so that forces on a
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
    std::vector<WallSegment> tiles_;       ///< or, where nothing is summed up, a share for each part
    std::vector<WallSums> sums_;           ///< of each tile
    std::vector<Tally> tallies_;           ///< of each part
};

}  // namespace grainsweep::dem::fast
