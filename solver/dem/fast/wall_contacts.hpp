// Contacts with walls: the pair law with R* = R, m* = m. A wall is a record of radius, inverse mass and spin zero
// that carries its velocity, so the motion of a contact is loaded like that of a pair; only the geometry is its own,
// and is formed in double precision. Torque arm R - d/2.
// Included by the files of the instruction paths; internal linkage on purpose.
#pragma once

#include "solver/dem/fast/contact.hpp"

namespace grainsweep::dem::fast {
namespace {

struct Surface {
    D distance;  ///< from the wall's surface to the centre
    D x, y, z;   ///< unit normal, towards the particle
};

GRAINSWEEP_LANES Surface plane_surface(const WallShape& w, D x, D y, D z) {
    const D nx = broadcast(w.normal[0]), ny = broadcast(w.normal[1]), nz = broadcast(w.normal[2]);
    return {fma(nx, x, fma(ny, y, nz * z)) - broadcast(w.offset), nx, ny, nz};
}

/// Closest point of the bar; below bottom + edge_radius the closest point of a bar thinner by edge_radius on each
/// side, from which the rounded edge keeps its radius. A centre inside is pushed out through the nearest face.
GRAINSWEEP_LANES Surface blade_surface(const WallShape& w, D x, D, D z) {
    const D zero = broadcast(0.0), one = broadcast(1.0), round = broadcast(w.edge_radius);
    D dx = x - broadcast(w.centre);
    dx = dx - broadcast(w.period) * nearest_integer(dx * broadcast(w.inverse_period));
    const D knee = broadcast(w.bottom + w.edge_radius);
    const D shrink = where_less(z, knee, round, zero);
    const D half = broadcast(w.half_width) - shrink;
    const D px = max(min(dx, half), zero - half);
    const D pz = max(min(z, broadcast(w.top)), broadcast(w.bottom) + shrink);
    const D ox = dx - px, oz = z - pz;
    const D length = sqrt(fma(ox, ox, oz * oz));
    const D outside = one * where_less(zero, length, one, zero);
    const D inverse_length = where_less(zero, length, one / max(length, broadcast(1e-30)), zero);
    // inside: depth below the nearest face, whose normal points out
    const D side = where_less(dx, zero, zero - one, one);
    const D depth_side = fma(side, dx, zero - broadcast(w.half_width));
    const D depth_bottom = broadcast(w.bottom) - z;
    const D depth_top = z - broadcast(w.top);
    const D vertical = max(depth_bottom, depth_top);
    const D up = where_less(depth_bottom, depth_top, one, zero - one);
    const D sideways = where_less(vertical, depth_side, one, zero);
    const D inside = one - outside;
    return {fma(outside, length - shrink, inside * max(vertical, depth_side)),
            fma(ox, inverse_length, inside * sideways * side), zero,
            fma(oz, inverse_length, inside * (one - sideways) * up)};
}

/// Sum over lanes of force times velocity.
GRAINSWEEP_LANES double work_of(V3 force, const float* velocity) {
    float lane[3][width];
    store(lane[0], force.x);
    store(lane[1], force.y);
    store(lane[2], force.z);
    double work = 0;
    for (int a = 0; a < 3; ++a)
        for (int q = 0; q < width; ++q) work += static_cast<double>(lane[a][q]) * static_cast<double>(velocity[a]);
    return work;
}

template <class Kernel>
void walls(const Field& f, Tally& t) {
    const unsigned denormals = flush_denormals();
    const Constants& c = f.constants;
    const typename Kernel::Laws laws(c.laws);
    F largest_overlap = broadcast(t.wall_overlap);
    Place origin[width];
    for (std::int32_t w = 0; w < f.wall_count; ++w) {
        const WallShape& shape = f.walls[w];
        for (int q = 0; q < width; ++q) origin[q] = static_cast<Place>(shape.record * places_per_index);
        V3 push{broadcast(0.0f), broadcast(0.0f), broadcast(0.0f)};
        for (std::int32_t k = f.segments[w].begin; k < f.segments[w].end; k += width) {
            const Place* particle = f.wall_particle + k;
            I ix, iy, iz;
            load_offsets(f.records, particle, origin, ix, iy, iz);
            const D x = exact(ix) * broadcast(c.unit[0]), y = exact(iy) * broadcast(c.unit[1]),
                    z = exact(iz) * broadcast(c.unit[2]);
            const Surface s = shape.is_blade != 0 ? blade_surface(shape, x, y, z) : plane_surface(shape, x, y, z);
            F rows[12];
            load_motion(f.records, particle, origin, rows);
            const F radius = rows[7];
            Meeting<Kernel, Partner::wall> m;
            m.time_step = broadcast(f.history_step);
            m.radius = radius;
            m.overlap = single(exact(radius) - s.distance);
            m.touching = broadcast(0.0f) < m.overlap;
            m.normal = {single(s.x), single(s.y), single(s.z)};
            m.velocity = {rows[0], rows[1], rows[2]};
            const F arm = fnma(broadcast(0.5f), m.overlap, radius);
            m.surface = V3{rows[4], rows[5], rows[6]} * arm;
            m.root_radius = radius * inverse_root(max(radius, broadcast(1e-12f)));
            m.inverse_masses = rows[3];
            if constexpr (Kernel::rolls) {
                m.turning = {rows[4], rows[5], rows[6]};
                m.rolling_inertia = inverse(rows[3] * inverse(max(radius * radius, broadcast(1e-12f))));
            }
            F memory[Kernel::histories + 1];
            load_memory<Kernel>(f.wall_history, k, memory);
            const auto [force, turn, rolling] = respond(laws, m, memory);
            if (f.history_step != 0) store_memory<Kernel>(f.wall_history, k, memory);
            largest_overlap = max(keep(m.touching, m.overlap * inverse(radius + radius)), largest_overlap);
            push = {push.x + force.x, push.y + force.y, push.z + force.z};
            const F forces[3] = {force.x, force.y, force.z};
            F torques[3] = {turn.x * arm, turn.y * arm, turn.z * arm};
            if constexpr (Kernel::rolls) {
                torques[0] = torques[0] - rolling.x;
                torques[1] = torques[1] - rolling.y;
                torques[2] = torques[2] - rolling.z;
            }
            scatter(f.forces, particle, forces, torques);
        }
        if (shape.is_blade != 0) t.wall_work += work_of(push, f.records[shape.record].velocity);
    }
    t.wall_overlap = largest(largest_overlap);
    restore_denormals(denormals);
}

}  // namespace
}  // namespace grainsweep::dem::fast
