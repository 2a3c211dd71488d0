// Contact histories of touching pairs, stored in the order of the neighbour list.
//
// When the list is rebuilt and the particles are sorted, a memory moves with its pair. Antisymmetric quantities (from j
// to i) change sign when i and j are exchanged.
#pragma once

#include "solver/particles/neighbour_list.hpp"

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace grainsweep::particles {

/// Index of a removed particle.
inline constexpr std::uint32_t gone = std::numeric_limits<std::uint32_t>::max();

class PairMemory {
public:
    /// `exchanged`: factor of every component when the particles of a pair are exchanged.
    explicit PairMemory(std::vector<double> exchanged) : exchanged_(std::move(exchanged)) {}

    std::vector<double> value;       ///< all components of one list entry, then of the next; zero if not `live`
    std::vector<std::uint8_t> live;  ///< 1: the pair touched at the last evaluation

    [[nodiscard]] std::size_t components() const { return exchanged_.size(); }
    /// Moves the values of `old` entries to the same pairs of `fresh`; fresh_index[i] is the new index of old i.
    void carry(const NeighbourList& old, const NeighbourList& fresh, std::span<const std::uint32_t> fresh_index);

private:
    struct Remembered {
        std::uint32_t j, entry;
        bool turned;
    };
    std::vector<double> exchanged_;
    std::vector<std::uint32_t> first_;
    std::vector<Remembered> remembered_;
};

}  // namespace grainsweep::particles
