// Places that spheres occupy, while particles are placed one by one.
#pragma once

#include "solver/geometry/domain.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <vector>

namespace grainsweep::machine {

using geometry::Vec3;

/// Spheres by cells of a width, at least the largest diameter.
class Neighbourhood {
public:
    Neighbourhood(const geometry::Domain& domain, double width) : domain_(domain), width_(width) {}

    void add(const Vec3& centre, double radius) { cells_[cell_of(centre)].push_back({centre, radius}); }
    /// Whether a sphere there would overlap one of them.
    [[nodiscard]] bool occupied(const Vec3& centre, double radius) const {
        for (int image = 0; image < 27; ++image) {
            const Vec3 place = image_of(centre, image);
            if (image != 13 && place == centre) continue;  // no such image
            if (overlaps(place, radius)) return true;
        }
        return false;
    }

private:
    using Cell = std::array<std::int64_t, 3>;
    struct Ball {
        Vec3 centre;
        double radius;
    };

    [[nodiscard]] Cell cell_of(const Vec3& x) const {
        Cell cell{};
        for (std::size_t k = 0; k < 3; ++k) cell[k] = static_cast<std::int64_t>(std::floor(x[k] / width_));
        return cell;
    }
    [[nodiscard]] Vec3 image_of(const Vec3& x, int image) const {
        const std::array<int, 3> shift = {image % 3 - 1, image / 3 % 3 - 1, image / 9 - 1};
        Vec3 moved = x;
        for (std::size_t k = 0; k < 3; ++k)
            if (domain_.periodic[k]) moved[k] += shift[k] * domain_.length(k);
        return moved;
    }
    [[nodiscard]] bool overlaps(const Vec3& centre, double radius) const {
        const Cell middle = cell_of(centre);
        for (std::int64_t x = -1; x <= 1; ++x)
            for (std::int64_t y = -1; y <= 1; ++y)
                for (std::int64_t z = -1; z <= 1; ++z) {
                    const auto found = cells_.find({middle[0] + x, middle[1] + y, middle[2] + z});
                    if (found == cells_.end()) continue;
                    for (const Ball& ball : found->second)
                        if (geometry::norm(geometry::operator-(ball.centre, centre)) < ball.radius + radius)
                            return true;
                }
        return false;
    }

    const geometry::Domain& domain_;
    double width_;
    std::map<Cell, std::vector<Ball>> cells_;
};

}  // namespace grainsweep::machine
