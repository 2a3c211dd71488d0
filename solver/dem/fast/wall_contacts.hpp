// Contacts with walls: the pair laws with R* = R, m* = m and the materials of the wall's surface. The places of contact
// are found in double precision (wall_places.hpp). The torque arm is R - d/2. A wall without sums is at rest: neither
// its velocity nor the places of contact are needed. The files of the instruction paths include this file; it has
// internal linkage on purpose.
#pragma once

#include "solver/dem/fast/wall_places.hpp"

namespace grainsweep::dem::fast {
namespace {

/// Sums over the lanes of one tile.
struct LaneSums {
    V3 force, torque;
    F power;
};

GRAINSWEEP_LANES V3 load_vector(const float (&rows)[3][wall_tile + 2 * width], int at) {
    return {load(rows[0] + at), load(rows[1] + at), load(rows[2] + at)};
}

GRAINSWEEP_LANES double sum_of(F a) {
    float lane[width];
    store(lane, a);
    double sum = 0;
    for (int q = 0; q < width; ++q) sum += static_cast<double>(lane[q]);
    return sum;
}
GRAINSWEEP_LANES void add_to(double* total, V3 a) {
    total[0] += sum_of(a.x);
    total[1] += sum_of(a.y);
    total[2] += sum_of(a.z);
}

/// Pads the last vector with a particle that never touches.
template <class Kernel>
GRAINSWEEP_LANES void fill_up(const Field& f, WallTile& t, int packed) {
    const F zero = broadcast(0.0f);
    store(t.particle + packed, broadcast(f.wall_filler * places_per_index));
    store(t.overlap + packed, broadcast(-1.0f));
    for (auto* rows : {&t.normal, &t.velocity, &t.lever})
        for (auto& row : *rows) store(row + packed, zero);
    for (int a = 0; a < Kernel::histories; ++a) store(t.memory[a] + packed, zero);
}

/// Applies the laws to the packed contacts: forces on the particles, new memories, and, if `summed`, the wall's sums.
template <class Kernel, bool summed>
GRAINSWEEP_PHASE void press(const Field& f, const typename Kernel::Laws& laws, WallTile& t, int batches,
                            float& wall_overlap, WallSums& sums) {
    F largest_overlap = broadcast(wall_overlap);
    LaneSums lanes{zero_vector(), zero_vector(), broadcast(0.0f)};
    for (int b = 0; b < batches; ++b) {
        const int at = b * width;
        const Place* particle = t.particle + at;
        F rows[8];
        load_motion(f.records, particle, rows);
        const F radius = rows[7];
        V3 surface_velocity;
        if constexpr (summed) surface_velocity = load_vector(t.velocity, at);
        Meeting<Kernel, Partner::wall> m;
        m.time_step = broadcast(f.history_step);
        m.radius = radius;
        m.overlap = load(t.overlap + at);
        m.touching = may_touch<Kernel>(m.overlap);
        m.normal = load_vector(t.normal, at);
        m.velocity = {rows[0], rows[1], rows[2]};
        if constexpr (summed) m.velocity = m.velocity - surface_velocity;
        const F arm = fnma(broadcast(0.5f), m.overlap, radius);
        m.surface = V3{rows[4], rows[5], rows[6]} * arm;
        m.root_radius = radius * inverse_root(max(radius, broadcast(1e-12f)));
        m.inverse_masses = rows[3];
        if constexpr (Kernel::holds)
            if (f.mobility != nullptr) [[unlikely]]
                m.inverse_masses = inverse_masses(f.mobility, particle, nullptr, m.normal);
        if constexpr (Kernel::rolls) {
            m.turning = {rows[4], rows[5], rows[6]};
            m.rolling_inertia = inverse(rows[3] * inverse(max(radius * radius, broadcast(1e-12f))));
        }
        F memory[Kernel::histories + 1];
        for (int a = 0; a < Kernel::histories; ++a) memory[a] = load(t.memory[a] + at);
        const auto [force, turn, rolling] = respond(laws, m, memory);
        for (int a = 0; a < Kernel::histories; ++a) store(t.memory[a] + at, memory[a]);
        largest_overlap = max(keep(m.touching, m.overlap * inverse(radius + radius)), largest_overlap);
        if constexpr (summed) {
            lanes.force = lanes.force + force;
            lanes.power = fma(force.x, surface_velocity.x,
                              fma(force.y, surface_velocity.y, fma(force.z, surface_velocity.z, lanes.power)));
            // the force acts in the middle of the overlap
            const V3 lever = fnma(broadcast(0.5f) * load(t.overlap + at), m.normal, load_vector(t.lever, at));
            lanes.torque = add_cross(lanes.torque, lever, force);
            if constexpr (Kernel::rolls) lanes.torque = lanes.torque - rolling;
        }
        const F forces[3] = {force.x, force.y, force.z};
        F torques[3] = {turn.x * arm, turn.y * arm, turn.z * arm};
        if constexpr (Kernel::rolls) {
            torques[0] = torques[0] - rolling.x;
            torques[1] = torques[1] - rolling.y;
            torques[2] = torques[2] - rolling.z;
        }
        scatter(f.forces, particle, forces, torques);
    }
    wall_overlap = largest(largest_overlap);
    if constexpr (!summed) return;
    add_to(sums.force, lanes.force);
    add_to(sums.torque, lanes.torque);
    sums.power += sum_of(lanes.power);
}

/// Applies the laws for one kind of particles after the other.
template <class Kernel>
void press_by_kinds(const Field& f, const PlacedWall& wall, WallTile& t, int packed, float& wall_overlap,
                    WallSums& sums) {
    const auto press_all = wall.summed != 0 ? press<Kernel, true> : press<Kernel, false>;
    WallTile of_kind;
    int from[wall_tile + 2 * width];
    for (std::int32_t kind = 0; kind < f.kinds; ++kind) {
        int count = 0;
        for (int q = 0; q < packed; ++q)
            if (f.kind[t.particle[q] / places_per_index] == kind) from[count++] = q;
        if (count == 0) continue;
        for (int k = 0; k < count; ++k) {
            const int q = from[k];
            of_kind.particle[k] = t.particle[q];
            of_kind.overlap[k] = t.overlap[q];
            for (int a = 0; a < 3; ++a) {
                of_kind.normal[a][k] = t.normal[a][q];
                of_kind.velocity[a][k] = t.velocity[a][q];
                of_kind.lever[a][k] = t.lever[a][q];
            }
            for (int a = 0; a < Kernel::histories; ++a) of_kind.memory[a][k] = t.memory[a][q];
        }
        fill_up<Kernel>(f, of_kind, count);
        const typename Kernel::Laws laws(wall.laws_of_kinds + kind * constants_at_most);
        press_all(f, laws, of_kind, (count + width - 1) / width, wall_overlap, sums);
        for (int k = 0; k < count; ++k)
            for (int a = 0; a < Kernel::histories; ++a) t.memory[a][from[k]] = of_kind.memory[a][k];
    }
}

/// Writes memories back to the list and clears those of particles that do not touch.
template <class Kernel>
GRAINSWEEP_LANES void return_memories(const Field& f, const WallTile& t, const WallProgress& p) {
    int at = 0, b = 0;
    for (std::int32_t k = p.begin; k < p.slot; k += width, ++b) {
        for (int a = 0; a < Kernel::histories; ++a)
            store(f.wall_history[a] + k, expand(load(t.memory[a] + at), p.touch[b]));
        at += __builtin_popcount(p.touch[b]);
    }
}

/// Copies `count` values of a column from index `from`, in whole vectors.
template <class T>
GRAINSWEEP_LANES void copy(T* to, const T* column, std::int32_t from, int count) {
    for (int q = 0; q < count; q += width) store(to + q, load(column + from + q));
}
template <class Kernel>
GRAINSWEEP_LANES void take_touches(const Field& f, std::int32_t from, int count, WallTile& t) {
    copy(t.particle, f.touch_particle, from, count);
    copy(t.overlap, f.touch_overlap, from, count);
    for (int a = 0; a < 3; ++a) {
        copy(t.normal[a], f.touch_normal[a], from, count);
        copy(t.velocity[a], f.touch_velocity[a], from, count);
        copy(t.lever[a], f.touch_lever[a], from, count);
    }
    for (int a = 0; a < Kernel::histories; ++a) copy(t.memory[a], f.touch_memory[a], from, count);
}
/// Writes exactly `count` memories back, because the next ones may belong to another wall.
template <class Kernel>
GRAINSWEEP_LANES void return_touches(const Field& f, std::int32_t from, int count, const WallTile& t) {
    for (int a = 0; a < Kernel::histories; ++a)
        for (int q = 0; q < count; ++q) f.touch_memory[a][from + q] = t.memory[a][q];
}

template <class Kernel>
void walls(const Field& f, std::int32_t w, WallSegment slots, Tally& tally, WallSums& sums) {
    if (slots.begin == slots.end) return;
    const auto denormals = flush_denormals();
    const PlacedWall& wall = f.walls[w];
    const typename Kernel::Laws laws(wall.laws);
    WallTile t;
    WallProgress p;
    const auto press_packed = [&](int packed) {
        if (packed == 0) return;
        if (f.kinds > 1) return press_by_kinds<Kernel>(f, wall, t, packed, tally.wall_overlap, sums);
        fill_up<Kernel>(f, t, packed);
        const auto press_all = wall.summed != 0 ? press<Kernel, true> : press<Kernel, false>;
        press_all(f, laws, t, (packed + width - 1) / width, tally.wall_overlap, sums);
    };
    if (const FindPlaces find = PlaceFinders<geometry::Shape>::of[wall.shape]; find != nullptr) {
        for (p.slot = slots.begin; p.slot < slots.end;) {
            find(f, wall, slots.end, t, p);
            press_packed(p.packed);
            if (f.history_step != 0) return_memories<Kernel>(f, t, p);
        }
    } else {
        for (std::int32_t from = slots.begin; from < slots.end; from += wall_tile) {
            const int count = from + wall_tile < slots.end ? wall_tile : slots.end - from;
            take_touches<Kernel>(f, from, count, t);
            press_packed(count);
            if (f.history_step != 0) return_touches<Kernel>(f, from, count, t);
        }
    }
    restore_denormals(denormals);
}

inline void mark_touching(const Field& f, std::int32_t wall, WallSegment slots, std::uint16_t* lanes) {
    const auto denormals = flush_denormals();
    PlaceFinders<geometry::Shape>::marking[f.walls[wall].shape](f, f.walls[wall], slots, lanes);
    restore_denormals(denormals);
}

}  // namespace
}  // namespace grainsweep::dem::fast
