#include "solver/particles/reach.hpp"

#include "solver/geometry/bounds.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>

namespace grainsweep::particles {
namespace {

using Point = std::array<double, 3>;
using Cube = std::array<std::int32_t, 3>;  // coordinates in cubes of edge h

constexpr std::int32_t per_diameter = 8;
constexpr double half_diagonal = 0.5 * std::numbers::sqrt3 / per_diameter;

/// 8 x 8 x 8 cubes: a word for each z, a byte of it for each y, a bit for each x.
using Cubes = std::array<std::uint64_t, 8>;

constexpr std::uint64_t low_x = 0x0101010101010101, high_x = low_x << 7U;
constexpr std::uint64_t low_y = 0xff, high_y = low_y << 56U;

/// The cubes on one face of a block. A face is an axis and a side, -1 or +1.
Cubes face(std::size_t axis, std::int32_t side) {
    Cubes cubes{};
    if (axis == 2) {
        cubes[side > 0 ? 7 : 0] = ~std::uint64_t{0};
    } else {
        const std::uint64_t low = axis == 0 ? low_x : low_y, high = axis == 0 ? high_x : high_y;
        cubes.fill(side > 0 ? high : low);
    }
    return cubes;
}

/// The water on that face, where it stands in the block beyond.
Cubes across(const Cubes& water, std::size_t axis, std::int32_t side) {
    Cubes beyond{};
    if (axis == 2) {
        beyond[side > 0 ? 0 : 7] = water[side > 0 ? 7 : 0];
        return beyond;
    }
    const unsigned step = axis == 0 ? 7 : 56;
    const auto edge = face(axis, side);
    for (std::size_t z = 0; z < 8; ++z) {
        const std::uint64_t at_edge = water[z] & edge[z];
        beyond[z] = side > 0 ? at_edge >> step : at_edge << step;
    }
    return beyond;
}

/// Cubes in blocks of one diameter; only blocks next to frozen spheres are stored, the rest is open.
class OpenSpace {
public:
    OpenSpace(std::span<const Point> frozen, double closest);
    void flood(std::span<const Point> mobile);
    /// Whether a flooded cube may hold a point within a distance of the centre.
    [[nodiscard]] bool floods_within(const Point& centre, double distance) const;

private:
    struct Block {
        Cube at;  ///< coordinates in blocks
        Cubes shut{}, flooded{};
        bool waits = false;  ///< is in front_
    };

    [[nodiscard]] Cube cube_of(const Point& x) const;
    [[nodiscard]] std::int64_t block_number(const Cube& c) const;  // negative: outside the box
    [[nodiscard]] static std::size_t word(const Cube& c) { return static_cast<std::size_t>(c[2] & 7); }
    [[nodiscard]] static std::uint64_t bit(const Cube& c) {
        return std::uint64_t{1} << static_cast<unsigned>((c[1] & 7) * 8 + (c[0] & 7));
    }
    [[nodiscard]] const Block* block(const Cube& c) const;
    [[nodiscard]] Block* block(const Cube& c) { return const_cast<Block*>(std::as_const(*this).block(c)); }
    void store_blocks_around(const Point& centre);
    void shut_cubes_within(const Point& centre, double distance);
    void seed_faces(Block& home);
    static void spread_inside(Block& home);
    void spread_beyond(const Block& home);
    /// Floods what of `water` is not shut; the block waits for its turn if that was new.
    void wet(Block& home, const Cubes& water);
    /// Calls visit(cube) for the cubes whose centre is nearer than distance, until it returns true.
    template <class Visit>
    bool any_cube_within(const Point& centre, double distance, Visit&& visit) const;

    Point low_{};
    Cube blocks_{};
    std::vector<std::int32_t> stored_;  // block -> its place in store_, or -1
    std::vector<Block> store_;
    std::vector<std::int32_t> front_;  // blocks whose water may spread
};

OpenSpace::OpenSpace(std::span<const Point> frozen, double closest) {
    const auto [low, high] = geometry::bounds_around(frozen);
    low_ = low;
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
                store_.push_back({.at = {(middle[0] + dx) >> 3, (middle[1] + dy) >> 3, (middle[2] + dz) >> 3}});
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
        block(c)->shut[word(c)] |= bit(c);  // stored: nearer than a block's edge
        return false;
    });
}

void OpenSpace::wet(Block& home, const Cubes& water) {
    std::uint64_t fresh = 0;
    for (std::size_t z = 0; z < 8; ++z) {
        const std::uint64_t here = water[z] & ~home.shut[z] & ~home.flooded[z];
        home.flooded[z] |= here;
        fresh |= here;
    }
    if (fresh == 0 || home.waits) return;
    home.waits = true;
    front_.push_back(static_cast<std::int32_t>(&home - store_.data()));
}

/// All that a block's water reaches without leaving it, a plane of cubes at a time.
void OpenSpace::spread_inside(Block& home) {
    Cubes& water = home.flooded;
    for (bool rises = true; rises;) {
        rises = false;
        for (std::size_t z = 0; z < 8; ++z) {
            const std::uint64_t w = water[z];
            std::uint64_t next = w | ((w & ~high_x) << 1U) | ((w & ~low_x) >> 1U) | (w << 8U) | (w >> 8U);
            if (z > 0) next |= water[z - 1];
            if (z < 7) next |= water[z + 1];
            next &= ~home.shut[z];
            rises = rises || next != w;
            water[z] = next;
        }
    }
}

void OpenSpace::spread_beyond(const Block& home) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const std::int32_t side : {-1, 1}) {
            Cube corner{8 * home.at[0], 8 * home.at[1], 8 * home.at[2]};
            corner[axis] += side * 8;
            if (Block* next = block(corner)) wet(*next, across(home.flooded, axis, side));
        }
}

/// Lets water in through faces to blocks that are not stored.
void OpenSpace::seed_faces(Block& home) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const std::int32_t side : {-1, 1}) {
            Cube beyond{8 * home.at[0], 8 * home.at[1], 8 * home.at[2]};
            beyond[axis] += side * 8;
            if (block(beyond) == nullptr) wet(home, face(axis, side));
        }
}

void OpenSpace::flood(std::span<const Point> mobile) {
    for (const Point& x : mobile) {
        const Cube c = cube_of(x);
        Cubes drop{};
        drop[word(c)] = bit(c);
        if (Block* home = block(c)) wet(*home, drop);
    }
    for (Block& home : store_) seed_faces(home);
    while (!front_.empty()) {
        Block& home = store_[static_cast<std::size_t>(front_.back())];
        front_.pop_back();
        home.waits = false;
        spread_inside(home);
        spread_beyond(home);
    }
}

bool OpenSpace::floods_within(const Point& centre, double distance) const {
    return any_cube_within(centre, distance + half_diagonal, [this](const Cube& c) {
        const Block* home = block(c);
        return home == nullptr || (home->flooded[word(c)] & bit(c)) != 0;
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
