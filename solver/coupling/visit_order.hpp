// Order of visits to the particles: neighbours in space follow each other, so that the field values that they gather
// are still in the cache. The motions of different particles are independent, so the order changes no bit.
#pragma once

#include "solver/coupling/cloud.hpp"
#include "solver/flow/field.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace grainsweep::coupling {

class VisitOrder {
public:
    /// Returns the order, sorted anew every `lifetime` calls, because few particles leave their cell between two sorts.
    const std::vector<std::uint32_t>& of(const Cloud& cloud, const flow::Grid& grid) {
        if (order_.size() != cloud.size() || age_ >= lifetime) sort(cloud, grid);
        ++age_;
        return order_;
    }

private:
    static constexpr int lifetime = 32;

    void sort(const Cloud& cloud, const flow::Grid& grid) {
        keys_.clear();
        for (std::uint32_t p = 0; p < cloud.size(); ++p) {
            std::uint64_t key = 0;
            for (int d = 2; d >= 0; --d)
                key = key * (static_cast<std::uint64_t>(grid.cells(d)) + 1) +
                      static_cast<std::uint64_t>(grid[d].cell_at(cloud.position[p][static_cast<std::size_t>(d)]));
            keys_.emplace_back(key, p);
        }
        std::sort(keys_.begin(), keys_.end());
        order_.clear();
        for (const auto& [key, p] : keys_) order_.push_back(p);
        age_ = 0;
    }

    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys_;
    std::vector<std::uint32_t> order_;
    int age_ = 0;
};

}  // namespace grainsweep::coupling
