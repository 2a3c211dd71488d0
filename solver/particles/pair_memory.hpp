// Contact histories of touching pairs, stored in the order of the neighbour list.
//
// When the list is rebuilt and the particles are sorted anew, a memory follows its pair; antisymmetric
// quantities (measured from j to i) change sign when i and j swap.
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

/// Memory of a pair that resists rolling: both quantities are antisymmetric.
struct TangentialAndRolling {
    Vec3 tangential{};
    Vec3 rolling{};

    friend TangentialAndRolling operator-(const TangentialAndRolling& a) {
        return {geometry::operator-(a.tangential), geometry::operator-(a.rolling)};
    }
};

/// Value: Vec3 or TangentialAndRolling.
template <class Value>
class PairMemory {
public:
    std::vector<Value> value;        ///< per list entry; zero where `live` is 0
    std::vector<std::uint8_t> live;  ///< 1: the pair touched at the last evaluation

    /// Values of `old` entries move to the same pairs of `fresh`; fresh_index[i] is the new index of old i.
    void carry(const NeighbourList& old, const NeighbourList& fresh, std::span<const std::uint32_t> fresh_index);

private:
    struct Remembered {
        std::uint32_t j;
        Value value;
    };
    std::vector<std::uint32_t> first_;
    std::vector<Remembered> remembered_;
};

extern template class PairMemory<Vec3>;
extern template class PairMemory<TangentialAndRolling>;

}  // namespace grainsweep::particles
