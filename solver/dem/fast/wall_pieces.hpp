// Search for the pieces of a wall that particles touch: one lane per particle and near piece, in double precision,
// rounded once. If the plane of a piece is touched inside all its sides, this is the contact. If a piece may be touched
// on a side, or a particle touches several pieces, the shape decides (wall_touches.cpp). The files of the instruction
// paths include this file; it has internal linkage on purpose.
#pragma once

#include "solver/dem/fast/wall_places.hpp"

namespace grainsweep::dem::fast {
namespace {

/// Lanes of particles and pieces that wait for the test.
struct PieceLanes {
    Place particle[width];
    std::int32_t entry[width];
    std::int32_t piece[width];
};

/// Appends the touched pieces to the columns. Returns their number.
template <class S>
GRAINSWEEP_LANES std::int32_t look_at(const Field& f, const PlacedWall& w, const PieceList& list,
                                      const PieceLanes& lanes, std::int32_t at) {
    constexpr int count = sizeof(typename S::PieceNumbers) / sizeof(double);
    alignas(64) double column[count][width];
    for (int q = 0; q < width; ++q) {
        const double* numbers = list.numbers + static_cast<std::int64_t>(lanes.piece[q]) * count;
        for (int k = 0; k < count; ++k) column[k][q] = numbers[k];
    }
    D numbers[count];
    for (int k = 0; k < count; ++k) numbers[k] = load(column[k]);
    const auto [r, radius] = before_wall(f, w, lanes.particle);
    const D3 body = w.turned != 0 ? to_body(w.rows, r) : r;
    const geometry::NearPiece<D> near = S::near_piece(numbers, body.x, body.y, body.z);

    const D zero = broadcast(0.0), one = broadcast(1.0);
    const D side = where_less(near.height, zero, zero - one, one), distance = side * near.height;
    const D reach = radius + broadcast(double{f.constants.beyond_wall});
    const D beyond = max(zero, zero - near.inside), disc = fnma(distance, distance, reach * reach);
    D status = where_less(broadcast(list.margin), near.inside, one, where_less(beyond * beyond, disc, one + one, zero));
    status = where_less(distance, reach, status, zero);
    const F kind = single(status);
    const Chosen touched(broadcast(0.0f) < kind);
    if (touched.bits == 0) return 0;
    const D3 plane{side * numbers[0], side * numbers[1], side * numbers[2]};
    const D3 normal = w.turned != 0 ? from_body(w.rows, plane) : plane;
    const D3 lever = fnma(distance, normal, r) - broadcast(w.pivot);
    const V3 material = single(material_velocity(w, lever, normal));
    const V3 direction = single(normal), arm = single(lever);
    const F overlap = select(kind < broadcast(1.5f), single(radius - distance), broadcast(undecided));
    store(f.touch_particle + at, compress(load(lanes.particle), touched));
    store(list.entry + at, compress(load(lanes.entry), touched));
    store(reinterpret_cast<std::int32_t*>(list.piece) + at, compress(load(lanes.piece), touched));
    store(f.touch_overlap + at, compress(overlap, touched));
    const auto keep_vector = [&](float* const* column_of, V3 v) {
        store(column_of[0] + at, compress(v.x, touched));
        store(column_of[1] + at, compress(v.y, touched));
        store(column_of[2] + at, compress(v.z, touched));
    };
    keep_vector(f.touch_normal, direction);
    keep_vector(f.touch_lever, arm);
    keep_vector(f.touch_velocity, material);
    return __builtin_popcount(touched.bits);
}

template <class S>
GRAINSWEEP_PHASE std::int32_t find_pieces_of(const Field& f, const PlacedWall& w, const PieceList& list,
                                             std::int32_t at) {
    PieceLanes lanes;
    const std::int32_t begin = at;
    int waiting = 0;
    for (std::int32_t n = 0; n < list.near; ++n)
        for (std::int32_t k = list.first[n]; k < list.first[n] + list.active[n]; ++k) {
            lanes.particle[waiting] = list.particle[n];
            lanes.entry[waiting] = n;
            lanes.piece[waiting] = static_cast<std::int32_t>(list.candidate[k]);
            const double* numbers = list.numbers + static_cast<std::int64_t>(lanes.piece[waiting]) * list.stride;
            prefetch(numbers);
            prefetch(numbers + 8);
            if (++waiting < width) continue;
            at += look_at<S>(f, w, list, lanes, at);
            waiting = 0;
        }
    if (waiting == 0) return at - begin;
    for (int q = waiting; q < width; ++q) {  // padding that never touches
        lanes.particle[q] = static_cast<Place>((f.count + 2) * places_per_index);
        lanes.entry[q] = lanes.piece[q] = 0;
    }
    at += look_at<S>(f, w, list, lanes, at);
    return at - begin;
}

using FindPieces = std::int32_t (*)(const Field&, const PlacedWall&, const PieceList&, std::int32_t at);

template <class S>
constexpr FindPieces find_pieces_in() {
    if constexpr (geometry::Pieced<S>) return find_pieces_of<S>;
    return nullptr;
}

/// Functions for each shape, in the order of the list.
template <class List>
struct PieceFinders;
template <class... Shapes>
struct PieceFinders<std::variant<Shapes...>> {
    static constexpr FindPieces of[] = {find_pieces_in<Shapes>()...};
};

std::int32_t find_pieces(const Field& f, std::int32_t wall, const PieceList& list, std::int32_t at) {
    const PlacedWall& w = f.walls[wall];
    return PieceFinders<geometry::Shape>::of[w.shape](f, w, list, at);
}

}  // namespace
}  // namespace grainsweep::dem::fast
