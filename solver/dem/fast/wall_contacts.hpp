// Contacts with walls: the pair law with R* = R, m* = m. What is touched where is found in double precision
// (wall_places.hpp); the partner of a particle is then a record without mass, spin and size, and the laws are those of
// the wall's surface. Torque arm R - d/2.
// Included by the files of the instruction paths; internal linkage on purpose.
#pragma once

#include "solver/dem/fast/wall_places.hpp"

namespace grainsweep::dem::fast {
namespace {

/// Sums over the lanes of one tile.
struct LaneSums {
    V3 force, torque;
    F power;
};

GRAINSWEEP_LANES V3 zero_vector() {
    return {broadcast(0.0f), broadcast(0.0f), broadcast(0.0f)};
}
GRAINSWEEP_LANES V3 operator+(V3 a, V3 b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
GRAINSWEEP_LANES V3 operator-(V3 a, V3 b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
GRAINSWEEP_LANES V3 load_vector(const float (&rows)[3][tile + 2 * width], int at) {
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

/// Fills the last vector up with a particle that never touches.
GRAINSWEEP_LANES void fill_up(const Field& f, WallTile& t, int packed) {
    for (int q = packed; q < packed + width; ++q) {
        t.particle[q] = static_cast<Place>((f.count + 2) * places_per_index);
        t.overlap[q] = -1;
        for (int a = 0; a < 3; ++a) t.normal[a][q] = t.velocity[a][q] = t.lever[a][q] = 0;
        for (auto& column : t.memory) column[q] = 0;
    }
}

/// The laws at the packed contacts: forces on the particles, new memories, sums for the wall.
template <class Kernel>
GRAINSWEEP_PHASE void press(const Field& f, const typename Kernel::Laws& laws, WallTile& t, int batches,
                            float& wall_overlap, WallSums& sums) {
    Place partner[width];
    for (int q = 0; q < width; ++q) partner[q] = static_cast<Place>((f.count + 3) * places_per_index);
    F largest_overlap = broadcast(wall_overlap);
    LaneSums lanes{zero_vector(), zero_vector(), broadcast(0.0f)};
    for (int b = 0; b < batches; ++b) {
        const int at = b * width;
        const Place* particle = t.particle + at;
        F rows[12];
        load_motion(f.records, particle, partner, rows);
        const F radius = rows[7];
        const V3 surface_velocity = load_vector(t.velocity, at);
        Meeting<Kernel, Partner::wall> m;
        m.time_step = broadcast(f.history_step);
        m.radius = radius;
        m.overlap = load(t.overlap + at);
        m.touching = may_touch<Kernel>(m.overlap);
        m.normal = load_vector(t.normal, at);
        m.velocity = V3{rows[0], rows[1], rows[2]} - surface_velocity;
        const F half_overlap = broadcast(0.5f) * m.overlap;
        const F arm = fnma(broadcast(0.5f), m.overlap, radius);
        m.surface = V3{rows[4], rows[5], rows[6]} * arm;
        m.root_radius = radius * inverse_root(max(radius, broadcast(1e-12f)));
        m.inverse_masses = rows[3];
        if constexpr (Kernel::rolls) {
            m.turning = {rows[4], rows[5], rows[6]};
            m.rolling_inertia = inverse(rows[3] * inverse(max(radius * radius, broadcast(1e-12f))));
        }
        F memory[Kernel::histories + 1];
        for (int a = 0; a < Kernel::histories; ++a) memory[a] = load(t.memory[a] + at);
        const auto [force, turn, rolling] = respond(laws, m, memory);
        for (int a = 0; a < Kernel::histories; ++a) store(t.memory[a] + at, memory[a]);
        largest_overlap = max(keep(m.touching, m.overlap * inverse(radius + radius)), largest_overlap);
        lanes.force = lanes.force + force;
        lanes.power = fma(force.x, surface_velocity.x,
                          fma(force.y, surface_velocity.y, fma(force.z, surface_velocity.z, lanes.power)));
        // the force acts in the middle of the overlap
        const V3 lever = fnma(half_overlap, m.normal, load_vector(t.lever, at));
        lanes.torque = add_cross(lanes.torque, lever, force);
        const F forces[3] = {force.x, force.y, force.z};
        F torques[3] = {turn.x * arm, turn.y * arm, turn.z * arm};
        if constexpr (Kernel::rolls) {
            torques[0] = torques[0] - rolling.x;
            torques[1] = torques[1] - rolling.y;
            torques[2] = torques[2] - rolling.z;
            lanes.torque = lanes.torque - rolling;
        }
        scatter(f.forces, particle, forces, torques);
    }
    wall_overlap = largest(largest_overlap);
    add_to(sums.force, lanes.force);
    add_to(sums.torque, lanes.torque);
    sums.power += sum_of(lanes.power);
}

/// Memories back to the list; those of particles that do not touch end.
GRAINSWEEP_LANES void return_memories(const Field& f, const WallTile& t, const WallProgress& p) {
    for (int a = 0; a < f.histories; ++a) {
        int at = 0, b = 0;
        for (std::int32_t k = p.begin; k < p.slot; k += width, ++b) {
            store(f.wall_history[a] + k, expand(load(t.memory[a] + at), p.touch[b]));
            at += __builtin_popcount(p.touch[b]);
        }
    }
}

/// Contacts that were found before, from number `from` on: `count` numbers of each column, in whole vectors.
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
/// Their memories back; no more than those, for the next may be another wall's.
template <class Kernel>
GRAINSWEEP_LANES void return_touches(const Field& f, std::int32_t from, int count, const WallTile& t) {
    for (int a = 0; a < Kernel::histories; ++a)
        for (int q = 0; q < count; ++q) f.touch_memory[a][from + q] = t.memory[a][q];
}

template <class Kernel>
void walls(const Field& f, Tally& tally) {
    const auto denormals = flush_denormals();
    WallTile t;
    WallProgress p;
    for (std::int32_t w = 0; w < f.wall_count; ++w) {
        const PlacedWall& wall = f.walls[w];
        const typename Kernel::Laws laws(wall.laws);
        WallSums sums{};
        const auto press_packed = [&](int packed) {
            fill_up(f, t, packed);
            press<Kernel>(f, laws, t, (packed + width - 1) / width, tally.wall_overlap, sums);
        };
        if (const FindPlaces find = PlaceFinders<geometry::Shape>::of[wall.shape]; find != nullptr) {
            const std::int32_t end = f.segments[w].end;
            for (p.slot = f.segments[w].begin; p.slot < end;) {
                find(f, wall, end, t, p);
                press_packed(p.packed);
                if (f.history_step != 0) return_memories(f, t, p);
            }
        } else {
            const std::int32_t end = f.touched[w].end;
            for (std::int32_t from = f.touched[w].begin; from < end; from += tile) {
                const int count = from + tile < end ? tile : end - from;
                take_touches<Kernel>(f, from, count, t);
                press_packed(count);
                if (f.history_step != 0) return_touches<Kernel>(f, from, count, t);
            }
        }
        f.wall_sums[w] = sums;
    }
    restore_denormals(denormals);
}

}  // namespace
}  // namespace grainsweep::dem::fast
