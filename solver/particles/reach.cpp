#include "solver/particles/reach.hpp"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace grainsweep::particles {
namespace {

using Point = std::array<double, 3>;
using Cube = std::array<std::int32_t, 3>;  // coordinates in cubes of edge h

constexpr std::int32_t per_diameter = 8;
constexpr double half_diagonal = 0.5 * std::numbers::sqrt3 / per_diameter;

/// Cubes in blocks of one diameter; only blocks next to frozen spheres are stored, the rest is open.
class OpenSpace {
public:
    OpenSpace(std::span<const Point> frozen, double closest);
    void flood(std::span<const Point> mobile);
    /// Whether a flooded cube may hold a point within a distance of the centre.
    [[nodiscard]] bool floods_within(const Point& centre, double distance) const;

private:
    struct Block {
        std::bitset<512> shut, flooded;
    };

    [[nodiscard]] Cube cube_of(const Point& x) const;
    [[nodiscard]] std::int64_t block_number(const Cube& c) const;  // negative: outside the box
    [[nodiscard]] static std::size_t place(const Cube& c) {
        return static_cast<std::size_t>(((c[2] & 7) * 8 + (c[1] & 7)) * 8 + (c[0] & 7));
    }
    [[nodiscard]] const Block* block(const Cube& c) const;
    void store_blocks_around(const Point& centre);
    void shut_cubes_within(const Point& centre, double distance);
    void flood_from(const Cube& c);
    /// Calls visit(cube) for the cubes whose centre is nearer than distance, until it returns true.
    template <class Visit>
    bool any_cube_within(const Point& centre, double distance, Visit&& visit) const;

    Point low_{};
    Cube blocks_{};
    std::vector<std::int32_t> stored_;  // block -> its place in store_, or -1
    std::vector<Block> store_;
    std::vector<Cube> front_;
};

OpenSpace::OpenSpace(std::span<const Point> frozen, double closest) {
    low_ = frozen.front();
    Point high = low_;
    for (const Point& x : frozen)
        for (std::size_t k = 0; k < 3; ++k) {
            low_[k] = std::min(low_[k], x[k]);
            high[k] = std::max(high[k], x[k]);
        }
    for (std::size_t k = 0; k < 3; ++k) {
        low_[k] -= 1.5;
        blocks_[k] = static_cast<std::int32_t>(std::ceil(high[k] + 1.5 - low_[k]));
    }
    stored_.assign(static_cast<std::size_t>(blocks_[0]) * static_cast<std::size_t>(blocks_[1]) *
                       static_cast<std::size_t>(blocks_[2]),
                   -1);
    for (const Point& x : frozen) store_blocks_around(x);
    for (const Point& x : frozen) shut_cubes_within(x, closest - half_diagonal);
}

Cube OpenSpace::cube_of(const Point& x) const {
    Cube c{};
    for (std::size_t k = 0; k < 3; ++k) c[k] = static_cast<std::int32_t>(std::floor((x[k] - low_[k]) * per_diameter));
    return c;
}

std::int64_t OpenSpace::block_number(const Cube& c) const {
    Cube b{};
    for (std::size_t k = 0; k < 3; ++k) {
        b[k] = c[k] >> 3;  // rounds down, also below zero
        if (b[k] < 0 || b[k] >= blocks_[k]) return -1;
    }
    return (static_cast<std::int64_t>(b[2]) * blocks_[1] + b[1]) * blocks_[0] + b[0];
}

const OpenSpace::Block* OpenSpace::block(const Cube& c) const {
    const std::int64_t number = block_number(c);
    if (number < 0 || stored_[static_cast<std::size_t>(number)] < 0) return nullptr;
    return &store_[static_cast<std::size_t>(stored_[static_cast<std::size_t>(number)])];
}

void OpenSpace::store_blocks_around(const Point& centre) {
    const Cube middle = cube_of(centre);
    for (std::int32_t dz = -8; dz <= 8; dz += 8)
        for (std::int32_t dy = -8; dy <= 8; dy += 8)
            for (std::int32_t dx = -8; dx <= 8; dx += 8) {
                const std::int64_t number = block_number({middle[0] + dx, middle[1] + dy, middle[2] + dz});
                if (number < 0 || stored_[static_cast<std::size_t>(number)] >= 0) continue;
                stored_[static_cast<std::size_t>(number)] = static_cast<std::int32_t>(store_.size());
                store_.emplace_back();
            }
}

template <class Visit>
bool OpenSpace::any_cube_within(const Point& centre, double distance, Visit&& visit) const {
    if (distance <= 0) return false;
    const Cube from = cube_of({centre[0] - distance, centre[1] - distance, centre[2] - distance});
    const Cube to = cube_of({centre[0] + distance, centre[1] + distance, centre[2] + distance});
    const auto gap = [&](std::int32_t c, std::size_t k) { return low_[k] + (c + 0.5) / per_diameter - centre[k]; };
    for (std::int32_t z = from[2]; z <= to[2]; ++z)
        for (std::int32_t y = from[1]; y <= to[1]; ++y) {
            const double rest = distance * distance - gap(z, 2) * gap(z, 2) - gap(y, 1) * gap(y, 1);
            for (std::int32_t x = from[0]; x <= to[0]; ++x)
                if (gap(x, 0) * gap(x, 0) < rest && visit(Cube{x, y, z})) return true;
        }
    return false;
}

void OpenSpace::shut_cubes_within(const Point& centre, double distance) {
    any_cube_within(centre, distance, [this](const Cube& c) {
        const auto number = static_cast<std::size_t>(block_number(c));  // stored: nearer than a block's edge
        store_[static_cast<std::size_t>(stored_[number])].shut.set(place(c));
        return false;
    });
}

void OpenSpace::flood_from(const Cube& c) {
    const std::int64_t number = block_number(c);
    if (number < 0 || stored_[static_cast<std::size_t>(number)] < 0) return;
    Block& home = store_[static_cast<std::size_t>(stored_[static_cast<std::size_t>(number)])];
    const std::size_t here = place(c);
    if (home.shut.test(here) || home.flooded.test(here)) return;
    home.flooded.set(here);
    front_.push_back(c);
}

void OpenSpace::flood(std::span<const Point> mobile) {
    for (const Point& x : mobile) flood_from(cube_of(x));
    // Every cube of a stored block that borders on one not stored.
    const auto seed = [this](Cube corner, std::size_t axis, std::int32_t side) {
        Cube beyond = corner;
        beyond[axis] += side * 8;
        if (block(beyond) != nullptr) return;
        corner[axis] += side > 0 ? 7 : 0;
        const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (std::int32_t i = 0; i < 8; ++i)
            for (std::int32_t j = 0; j < 8; ++j) {
                Cube c = corner;
                c[u] += i;
                c[v] += j;
                flood_from(c);
            }
    };
    for (std::int32_t z = 0; z < blocks_[2]; ++z)
        for (std::int32_t y = 0; y < blocks_[1]; ++y)
            for (std::int32_t x = 0; x < blocks_[0]; ++x) {
                const Cube corner = {8 * x, 8 * y, 8 * z};
                if (block(corner) == nullptr) continue;
                for (std::size_t axis = 0; axis < 3; ++axis)
                    for (const std::int32_t side : {-1, 1}) seed(corner, axis, side);
            }
    while (!front_.empty()) {
        const Cube c = front_.back();
        front_.pop_back();
        for (std::size_t axis = 0; axis < 3; ++axis)
            for (const std::int32_t side : {-1, 1}) {
                Cube next = c;
                next[axis] += side;
                flood_from(next);
            }
    }
}

bool OpenSpace::floods_within(const Point& centre, double distance) const {
    return any_cube_within(centre, distance + half_diagonal, [this](const Cube& c) {
        const Block* home = block(c);
        return home == nullptr || home->flooded.test(place(c));
    });
}

}  // namespace

std::vector<bool> reachable(std::span<const Point> frozen, std::span<const Point> mobile, double closest) {
    std::vector<bool> touched(frozen.size());
    if (frozen.empty()) return touched;
    OpenSpace space(frozen, closest);
    space.flood(mobile);
    for (std::size_t i = 0; i < frozen.size(); ++i) touched[i] = space.floods_within(frozen[i], 1);
    return touched;
}

}  // namespace grainsweep::particles
