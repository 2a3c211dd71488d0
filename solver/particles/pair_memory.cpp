#include "solver/particles/pair_memory.hpp"

#include <algorithm>

namespace grainsweep::particles {

using namespace geometry;

template <class Value>
void PairMemory<Value>::carry(const NeighbourList& old, const NeighbourList& fresh,
                              std::span<const std::uint32_t> fresh_index) {
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
        remembered_[--first_[std::min(a, b)]] = a < b ? Remembered{b, v} : Remembered{a, -v};
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

template class PairMemory<Vec3>;
template class PairMemory<TangentialAndRolling>;

}  // namespace grainsweep::particles
