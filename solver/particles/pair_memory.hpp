// What touching pairs remember, stored in the order of the neighbour list.
//
// When the list is rebuilt and the particles are sorted anew, a memory follows its pair; an antisymmetric
// quantity (measured from j to i) changes sign when i and j swap.
#pragma once

#include "solver/particles/neighbour_list.hpp"
#include "solver/particles/particles.hpp"

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace grainsweep::particles {

/// Index of a particle that is no longer there.
inline constexpr std::uint32_t gone = std::numeric_limits<std::uint32_t>::max();

class PairMemory {
public:
    std::vector<Vec3> value;         ///< per list entry; zero where `live` is 0
    std::vector<std::uint8_t> live;  ///< 1: the pair touched at the last evaluation

    /// Values of `old` entries move to the same pairs of `fresh`; fresh_index[i] is the new index of old i.
    void carry(const NeighbourList& old, const NeighbourList& fresh, std::span<const std::uint32_t> fresh_index);

private:
    struct Remembered {
        std::uint32_t j;
        Vec3 value;
    };
    std::vector<std::uint32_t> first_;
    std::vector<Remembered> remembered_;
};

}  // namespace grainsweep::particles
