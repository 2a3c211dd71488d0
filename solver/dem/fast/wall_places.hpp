// Search for the places where particles touch walls. For each shape of the list, a function over lanes transforms the
// particles near a wall to its frame and packs those that touch. Positions, distances and velocities of the wall's
// material are computed in double precision and rounded once. The files of the instruction paths include this file; it
// has internal linkage on purpose.
#pragma once

#include "solver/dem/fast/contact.hpp"
#include "solver/geometry/shapes.hpp"

#include <type_traits>
#include <utility>
#include <variant>

namespace grainsweep::dem::fast {
namespace {

GRAINSWEEP_LANES D like(D, double value) {
    return broadcast(value);
}

/// Packed contacts with one wall.
struct alignas(64) WallTile {
    Place particle[wall_tile + 2 * width];
    float overlap[wall_tile + 2 * width];
    float normal[3][wall_tile + 2 * width];
    float velocity[3][wall_tile + 2 * width];  ///< of the wall's material; only for a wall with sums
    float lever[3][wall_tile + 2 * width];     ///< from the wall's pivot to the place on its surface; only for a wall
                                               ///< with sums
    float memory[histories_at_most][wall_tile + 2 * width];
};

/// Progress in a wall's list.
struct WallProgress {
    std::int32_t slot;                    ///< next entry
    std::int32_t begin;                   ///< first of this tile
    std::int32_t packed;                  ///< contacts in it
    std::uint16_t touch[listed_vectors];  ///< touching lanes of each vector of the list
};

/// Particles before a wall: positions relative to the origin of its nearest image, and radii. Whole units would shift
/// the overlap of a rolling sphere by up to 3e-3 of itself in a wide domain; radii of single precision by 1e-4.
struct BeforeWall {
    D3 position;
    D radius;
};
GRAINSWEEP_LANES BeforeWall before_wall(const Field& f, const PlacedWall& w, const Place* particle) {
    I whole[3];
    F below[4];
    load_positions(f.records, particle, whole[0], whole[1], whole[2]);
    load_below_units(f, particle, below);
    const auto along = [&](int a) { return (exact(whole[a]) + exact(below[a])) * broadcast(f.constants.unit[a]); };
    D3 r = D3{along(0), along(1), along(2)} - broadcast(w.origin);
    if (w.imaged != 0) {
        const auto image = [&](D a, int k) {
            return a - broadcast(w.period[k]) *
                           nearest_integer((a - broadcast(w.middle[k])) * broadcast(w.inverse_period[k]));
        };
        r = {image(r.x, 0), image(r.y, 1), image(r.z, 2)};
    }
    return {r, exact(load_radii(f.records, particle)) + exact(below[3])};
}

GRAINSWEEP_LANES D3 to_body(const double (&rows)[3][3], D3 a) {
    const auto along = [&](int k) {
        return fma(broadcast(rows[0][k]), a.x, fma(broadcast(rows[1][k]), a.y, broadcast(rows[2][k]) * a.z));
    };
    return {along(0), along(1), along(2)};
}
GRAINSWEEP_LANES D3 from_body(const double (&rows)[3][3], D3 a) {
    const auto along = [&](int k) {
        return fma(broadcast(rows[k][0]), a.x, fma(broadcast(rows[k][1]), a.y, broadcast(rows[k][2]) * a.z));
    };
    return {along(0), along(1), along(2)};
}

/// Returns distance and normal of the wall's closest points.
template <class S>
GRAINSWEEP_LANES geometry::Near<D> nearest(const PlacedWall& w, D3 r) {
    typename S::Numbers numbers;
    static_assert(sizeof numbers <= numbers_at_most && std::is_trivially_copyable_v<typename S::Numbers>);
    __builtin_memcpy(&numbers, w.numbers, sizeof numbers);
    if (w.turned == 0) return near(numbers, r.x, r.y, r.z);
    const D3 body = to_body(w.rows, r);
    geometry::Near<D> found = near(numbers, body.x, body.y, body.z);
    const D3 normal = from_body(w.rows, {found.x, found.y, found.z});
    return {found.distance, normal.x, normal.y, normal.z};
}

/// Particles of a vector of the list relative to a wall: positions, closest points and overlaps.
template <class S>
struct Approach {
    D3 position;
    geometry::Near<D> surface;
    F overlap;

    GRAINSWEEP_LANES Approach(const Field& f, const PlacedWall& w, const Place* particle)
        : Approach(w, before_wall(f, w, particle)) {}
    GRAINSWEEP_LANES Approach(const PlacedWall& w, const BeforeWall& spheres)
        : position(spheres.position),
          surface(nearest<S>(w, position)),
          overlap(single(spheres.radius - surface.distance)) {}
    /// Returns the lanes that touch, or whose contact may last beyond touch.
    GRAINSWEEP_LANES Chosen near(const Field& f) const { return Chosen(broadcast(-f.constants.beyond_wall) < overlap); }
};

GRAINSWEEP_LANES void store(float (&rows)[3][wall_tile + 2 * width], int at, V3 a, Chosen lanes) {
    store(rows[0] + at, compress(a.x, lanes));
    store(rows[1] + at, compress(a.y, lanes));
    store(rows[2] + at, compress(a.z, lanes));
}

/// Returns the velocity of the surface at a place, from its lever about the pivot and its normal.
GRAINSWEEP_LANES D3 material_velocity(const PlacedWall& w, D3 lever, D3 normal) {
    D3 velocity = broadcast(w.velocity);
    if (w.turns != 0) velocity = add_cross(velocity, broadcast(w.spin), lever);
    if (w.conveys == 0) return velocity;
    const D3 surface = broadcast(w.surface);
    return velocity + fnma(dot(surface, normal), normal, surface);
}

/// Packs these particles from p.slot to `end`, or until a tile is full.
template <class S>
GRAINSWEEP_PHASE void find_places(const Field& f, const PlacedWall& w, std::int32_t end, WallTile& t, WallProgress& p) {
    const D3 origin = broadcast(w.pivot), velocity = broadcast(w.velocity);
    p.begin = p.slot;
    p.packed = 0;
    const V3 carried = single(velocity);
    const bool uniform = w.turns == 0 && w.conveys == 0, summed = w.summed != 0;
    const int histories = f.histories;
    for (int b = 0; b < listed_vectors && p.slot < end && p.packed < wall_tile; ++b, p.slot += width) {
        const Place* particle = f.wall_particle + p.slot;
        const Approach<S> to_wall(f, w, particle);
        const Chosen lanes = to_wall.near(f);
        p.touch[b] = static_cast<std::uint16_t>(lanes.bits);
        if (lanes.bits == 0) continue;
        const geometry::Near<D>& surface = to_wall.surface;
        const D3 normal{surface.x, surface.y, surface.z};
        store(t.particle + p.packed, compress(load(particle), lanes));
        store(t.overlap + p.packed, compress(to_wall.overlap, lanes));
        store(t.normal, p.packed, single(normal), lanes);
        if (summed) {
            const D3 lever = fnma(surface.distance, normal, to_wall.position) - origin;
            store(t.lever, p.packed, single(lever), lanes);
            store(t.velocity, p.packed, uniform ? carried : single(material_velocity(w, lever, normal)), lanes);
        }
        for (int a = 0; a < histories; ++a)
            store(t.memory[a] + p.packed, compress(load(f.wall_history[a] + p.slot), lanes));
        p.packed += __builtin_popcount(lanes.bits);
    }
}

/// Implements Kernels::touching.
template <class S>
GRAINSWEEP_PHASE void mark_places(const Field& f, const PlacedWall& w, WallSegment slots, std::uint16_t* lanes) {
    for (std::int32_t slot = slots.begin; slot < slots.end; slot += width)
        *lanes++ = static_cast<std::uint16_t>(Approach<S>(f, w, f.wall_particle + slot).near(f).bits);
}

using FindPlaces = void (*)(const Field&, const PlacedWall&, std::int32_t end, WallTile&, WallProgress&);

template <class S>
constexpr FindPlaces find_places_of() {
    if constexpr (geometry::Vectorised<S>) return find_places<S>;
    return nullptr;
}
using MarkPlaces = void (*)(const Field&, const PlacedWall&, WallSegment, std::uint16_t* lanes);

template <class S>
constexpr MarkPlaces mark_places_of() {
    if constexpr (geometry::Vectorised<S>) return mark_places<S>;
    return nullptr;
}

/// Functions for each shape, in the order of the list.
template <class List>
struct PlaceFinders;
template <class... Shapes>
struct PlaceFinders<std::variant<Shapes...>> {
    static constexpr FindPlaces of[] = {find_places_of<Shapes>()...};
    static constexpr MarkPlaces marking[] = {mark_places_of<Shapes>()...};
};

}  // namespace
}  // namespace grainsweep::dem::fast
