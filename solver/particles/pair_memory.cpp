#include "solver/particles/pair_memory.hpp"

#include <algorithm>

namespace grainsweep::particles {

void PairMemory::carry(const NeighbourList& old, const NeighbourList& fresh,
                       std::span<const std::uint32_t> fresh_index) {
    // Buckets by the pair's first particle in the new order.
    const auto for_each_live = [&](auto&& visit) {
        for (std::size_t i = 0; i < old.particles(); ++i)
            for (std::uint32_t k = old.begin(i); k < old.end(i); ++k) {
                if (live[k] == 0) continue;
                const std::uint32_t a = fresh_index[i];
                const std::uint32_t b = fresh_index[old[k].j()];
                if (a == gone || b == gone) continue;
                visit(a, b, k);
            }
    };
    first_.assign(fresh.particles() + 1, 0);
    for_each_live([&](std::uint32_t a, std::uint32_t b, std::uint32_t) { ++first_[std::min(a, b)]; });
    std::uint32_t total = 0;
    for (auto& entry : first_) {
        total += entry;
        entry = total;  // one past the bucket's end; filling moves it to the beginning
    }
    remembered_.resize(total);
    for_each_live([&](std::uint32_t a, std::uint32_t b, std::uint32_t k) {
        remembered_[--first_[std::min(a, b)]] = {std::max(a, b), k, a > b};
    });
    const std::vector<double> before = std::move(value);
    value.assign(fresh.size() * components(), 0);
    live.assign(fresh.size(), 0);
    for (std::size_t i = 0; i < fresh.particles(); ++i)
        for (std::uint32_t m = first_[i]; m < first_[i + 1]; ++m)
            for (std::uint32_t k = fresh.begin(i); k < fresh.end(i); ++k)
                if (const auto& [j, entry, turned] = remembered_[m]; fresh[k].j() == j) {
                    for (std::size_t c = 0; c < components(); ++c)
                        value[k * components() + c] = before[entry * components() + c] * (turned ? exchanged_[c] : 1.0);
                    live[k] = 1;
                    break;
                }
}

}  // namespace grainsweep::particles
