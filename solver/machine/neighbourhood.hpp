// Places that spheres occupy: of particles that are placed one by one, and of points that are counted.
#pragma once

#include "solver/geometry/domain.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace grainsweep::machine {

using geometry::Vec3;

/// Spheres by cells of a width, at least the largest diameter. Periods hold two such spheres or more.
class Neighbourhood {
public:
    Neighbourhood(const geometry::Domain& domain, double width) : domain_(domain) {
        for (std::size_t k = 0; k < 3; ++k) {
            count_[k] =
                domain.periodic[k] ? std::max<std::int64_t>(1, std::llround(std::floor(domain.length(k) / width))) : 0;
            edge_[k] = count_[k] > 0 ? domain.length(k) / static_cast<double>(count_[k]) : width;
        }
    }

    void add(const Vec3& centre, double radius) {
        largest_ = std::max(largest_, radius);
        cells_[wrapped(cell_of(centre))].push_back({centre, radius});
    }
    /// Returns whether a sphere there would overlap one of them; of radius 0, whether the point lies in one.
    [[nodiscard]] bool occupied(const Vec3& centre, double radius) const {
        const double reach = (radius + largest_) * (1 + 1e-9);
        const Cell first = cell_of({centre[0] - reach, centre[1] - reach, centre[2] - reach});
        const Cell last = cell_of({centre[0] + reach, centre[1] + reach, centre[2] + reach});
        for (std::int64_t x = first[0]; x <= last[0]; ++x)
            for (std::int64_t y = first[1]; y <= last[1]; ++y)
                for (std::int64_t z = first[2]; z <= last[2]; ++z) {
                    const auto found = cells_.find(wrapped({x, y, z}));
                    if (found == cells_.end()) continue;
                    for (const Ball& ball : found->second)
                        if (geometry::norm(domain_.separation(centre, ball.centre)) < ball.radius + radius) return true;
                }
        return false;
    }

private:
    using Cell = std::array<std::int64_t, 3>;
    /// Teschner et al. (2003), Optimized spatial hashing for collision detection, section 4.1.
    struct Hash {
        std::size_t operator()(const Cell& cell) const {
            const auto at = [&](std::size_t k) { return static_cast<std::size_t>(cell[k]); };
            return (at(0) * 73856093) ^ (at(1) * 19349663) ^ (at(2) * 83492791);
        }
    };
    struct Ball {
        Vec3 centre;
        double radius;
    };

    [[nodiscard]] Cell wrapped(Cell cell) const {
        for (std::size_t k = 0; k < 3; ++k)
            if (count_[k] > 0) cell[k] = (cell[k] % count_[k] + count_[k]) % count_[k];
        return cell;
    }
    [[nodiscard]] Cell cell_of(const Vec3& x) const {
        Cell cell{};
        for (std::size_t k = 0; k < 3; ++k)
            cell[k] = static_cast<std::int64_t>(std::floor((x[k] - domain_.low[k]) / edge_[k]));
        return cell;
    }

    const geometry::Domain& domain_;
    Cell count_{};  ///< cells of a period; 0: the axis has none
    Vec3 edge_{};
    double largest_ = 0;  ///< radius
    std::unordered_map<Cell, std::vector<Ball>, Hash> cells_;
};

}  // namespace grainsweep::machine
