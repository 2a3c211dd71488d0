// Contact histories of touching pairs, stored in the order of the neighbour list.
//
// When the list is rebuilt and the particles are sorted anew, a memory follows its pair; antisymmetric
// quantities (measured from j to i) change sign when i and j swap.
#pragma once

#include "solver/particles/neighbour_list.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace grainsweep::particles {

/// Index of a particle that is no longer there.
inline constexpr std::uint32_t gone = std::numeric_limits<std::uint32_t>::max();

template <std::size_t components>
class PairMemory {
public:
    using Value = std::array<double, components>;

    std::vector<Value> value;        ///< per list entry; zero where `live` is 0
    std::vector<std::uint8_t> live;  ///< 1: the pair touched at the last evaluation

    /// Values of `old` entries move to the same pairs of `fresh`; fresh_index[i] is the new index of old i. Components
    /// of a pair whose particles change places take the factors `exchanged`.
    void carry(const NeighbourList& old, const NeighbourList& fresh, std::span<const std::uint32_t> fresh_index,
               const Value& exchanged);

private:
    struct Remembered {
        std::uint32_t j;
        Value value;
    };
    std::vector<std::uint32_t> first_;
    std::vector<Remembered> remembered_;
};

template <std::size_t components>
void PairMemory<components>::carry(const NeighbourList& old, const NeighbourList& fresh,
                                   std::span<const std::uint32_t> fresh_index, const Value& exchanged) {
    // Buckets by the pair's first particle in the new order.
    const auto for_each_live = [&](auto&& visit) {
        for (std::size_t i = 0; i < old.particles(); ++i)
            for (std::uint32_t k = old.begin(i); k < old.end(i); ++k) {
                if (live[k] == 0) continue;
                const std::uint32_t a = fresh_index[i];
                const std::uint32_t b = fresh_index[old[k].j()];
                if (a == gone || b == gone) continue;
                visit(a, b, value[k]);
            }
    };
    first_.assign(fresh.particles() + 1, 0);
    for_each_live([&](std::uint32_t a, std::uint32_t b, const Value&) { ++first_[std::min(a, b)]; });
    std::uint32_t total = 0;
    for (auto& entry : first_) {
        total += entry;
        entry = total;  // one past the bucket's end; filling moves it to the beginning
    }
    remembered_.resize(total);
    for_each_live([&](std::uint32_t a, std::uint32_t b, const Value& v) {
        Remembered& r = remembered_[--first_[std::min(a, b)]];
        r = {std::max(a, b), v};
        if (a > b)
            for (std::size_t c = 0; c < components; ++c) r.value[c] *= exchanged[c];
    });
    value.assign(fresh.size(), Value{});
    live.assign(fresh.size(), 0);
    for (std::size_t i = 0; i < fresh.particles(); ++i)
        for (std::uint32_t m = first_[i]; m < first_[i + 1]; ++m)
            for (std::uint32_t k = fresh.begin(i); k < fresh.end(i); ++k)
                if (fresh[k].j() == remembered_[m].j) {
                    value[k] = remembered_[m].value;
                    live[k] = 1;
                    break;
                }
}

}  // namespace grainsweep::particles
