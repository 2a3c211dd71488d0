// Sweep: one pass over the particles with four phases.
//
//   sift      position differences of the listed pairs, in single precision, decide which may touch. These pairs and
//             their histories are packed. Other pairs cause no further work.
//   meet      packed pairs in tiles: motion is loaded and transposed, the law is evaluated.
//   scatter   forces of a tile are added to both particles.
//   advance   a particle is integrated as soon as all its pairs are done, while it is in the nearest cache
//             (integration.hpp).
//
// R^2 - r^2 is computed in double precision from exact differences, so overlap = (R^2 - r^2)/(R + r) is accurate for
// any stiffness. The files of the instruction paths include this file; it has internal linkage on purpose.
#pragma once

#include "solver/dem/fast/integration.hpp"
#include "solver/dem/fast/law_table.hpp"

#include <cstring>
#include <type_traits>

namespace grainsweep::dem::fast {
namespace {

/// Buffers of packed pairs that may touch: one tile and a remainder.
struct alignas(64) Packed {
    Place first[tile + 2 * width];
    Place second[tile + 2 * width];
    std::int32_t offset[3][tile + 2 * width];
    float outcome[tile / width + 1][9][width];
    float memory[histories_at_most][tile + 2 * width];  ///< only if histories are streamed
};

/// Progress of a sweep.
struct Progress {
    std::int32_t batch;    ///< next vector of the inner list to be sifted
    std::int32_t packed;   ///< pairs in the buffers
    std::int32_t done;     ///< particles integrated
    std::int64_t read;     ///< histories read from the stream of the last step
    std::int64_t written;  ///< histories written to the stream of this step
    std::int64_t met;      ///< written histories whose contacts are evaluated
};

/// Sifts batches until a tile is full or the list ends. `streams`: histories stay in the buffers until meet() evaluates
/// them and writes them past the caches. Otherwise they are evaluated in place.
template <class Kernel, bool streams>
GRAINSWEEP_PHASE void sift(const Field& f, std::int32_t batches, Packed& p, Progress& progress) {
    const Constants& c = f.constants;
    const F ux = broadcast(c.unit_single[0]), uy = broadcast(c.unit_single[1]), uz = broadcast(c.unit_single[2]);
    Progress s = progress;
    for (; s.batch < batches && s.packed < tile; ++s.batch) {
        const std::int64_t k = static_cast<std::int64_t>(s.batch) * width;
        const Place* first = f.inner_first + k;
        const Place* second = f.inner_second + k;
        if (f.read_ahead != 0) {
            for (int q = 0; q < width; ++q) prefetch(record_at(f.records, second[q + 64]));
            if (Kernel::holds && f.mobility != nullptr)
                for (int q = 0; q < width; ++q) prefetch(f.mobility + second[q + 64] / places_per_index);
            if constexpr (Kernel::histories > 0)
                for (int a = 0; a < Kernel::histories; ++a) {
                    prefetch(f.history[a] + s.read + 256);
                    if constexpr (!streams) prefetch(f.history_next[a] + s.written + 256);
                }
        }
        I ix, iy, iz;
        load_offsets(f.records, first, second, ix, iy, iz);
        const F x = single(ix) * ux, y = single(iy) * uy, z = single(iz) * uz;
        F reach = broadcast(c.candidate_squared);
        if constexpr (Kernel::unequal) reach = load(f.inner_reach + k);
        const Chosen near(fma(x, x, fma(y, y, z * z)) < reach);
        const unsigned now = near.bits;
        store(p.first + s.packed, compress(load(first), near));
        store(p.second + s.packed, compress(load(second), near));
        store(p.offset[0] + s.packed, compress(ix, near));
        store(p.offset[1] + s.packed, compress(iy, near));
        store(p.offset[2] + s.packed, compress(iz, near));
        const int count = __builtin_popcount(now);
        if constexpr (Kernel::histories > 0) {
            const auto keep_history = [&](int a, F memory) {
                store(streams ? p.memory[a] + s.packed : f.history_next[a] + s.written, memory);
            };
            const unsigned before = f.touching[s.batch];
            if (before == now)  // most vectors keep their contacts
                for (int a = 0; a < Kernel::histories; ++a) keep_history(a, load(f.history[a] + s.read));
            else
                for (int a = 0; a < Kernel::histories; ++a)
                    keep_history(a, compress(expand(load(f.history[a] + s.read), before), near));
            f.touching_next[s.batch] = static_cast<std::uint16_t>(now);
            s.read += __builtin_popcount(before);
            s.written += count;
        }
        s.packed += count;
    }
    progress = s;
}

/// Returns R^2 - r^2 from exact differences, rounded once.
GRAINSWEEP_LANES F closeness(const Constants& c, I x, I y, I z, D reach_squared) {
    const D dx = exact(x) * broadcast(c.unit[0]), dy = exact(y) * broadcast(c.unit[1]),
            dz = exact(z) * broadcast(c.unit[2]);
    return single(fnma(dx, dx, fnma(dy, dy, fnma(dz, dz, reach_squared))));
}

/// Returns the sum over both particles of 1/(m R^2).
GRAINSWEEP_LANES F sum_of_turning_masses(const Record* records, const Place* first, const Place* second) {
    float sum[width];
    for (int q = 0; q < width; ++q) {
        const Record &a = *record_at(records, first[q]), &b = *record_at(records, second[q]);
        sum[q] =
            a.inverse_mass * a.inverse_radius * a.inverse_radius + b.inverse_mass * b.inverse_radius * b.inverse_radius;
    }
    return load(sum);
}

/// Laws of the pairs: the same for all, or by the kinds of both particles.
template <class Kernel, bool several>
struct PairLaws {
    using Laws = typename Kernel::Laws;
    explicit PairLaws(const Field& f) : all(f.constants.laws) {}
    GRAINSWEEP_LANES const Laws& of(const Field&, const Place*, const Place*) const { return all; }
    Laws all;
};
template <class Kernel>
struct PairLaws<Kernel, true> {
    using Laws = typename Kernel::Laws;
    explicit PairLaws(const Field& f) : table(f.laws_of_pairs, f.kinds * f.kinds) {}
    GRAINSWEEP_LANES Laws of(const Field& f, const Place* first, const Place* second) const {
        std::int32_t row[width];
        for (int q = 0; q < width; ++q)
            row[q] = f.kind[first[q] / places_per_index] * f.kinds + f.kind[second[q] / places_per_index];
        return table.at(load(row));
    }
    LawTable<Laws> table;
};

/// Computes force and torques of the packed pairs into the rows of results. Histories begin at index `at` of the
/// stream.
template <class Kernel, bool streams, bool several>
GRAINSWEEP_PHASE void meet(const Field& f, const PairLaws<Kernel, several>& laws, Packed& p, int batches,
                           std::int64_t at, Tally& t) {
    const Constants& c = f.constants;
    F largest_overlap = broadcast(t.overlap);
    const F half = broadcast(0.5f);
    for (int b = 0; b < batches; ++b) {
        const Place* first = p.first + b * width;
        const Place* second = p.second + b * width;
        if (f.read_ahead != 0)
            for (int q = 0; q < width; ++q) prefetch(force_at(f.forces, second[q]));
        F row[12];
        load_motion(f.records, first, second, row);
        if constexpr (Kernel::unequal) load_surface(f.records, first, second, row + 8);
        const I ix = load(p.offset[0] + b * width), iy = load(p.offset[1] + b * width),
                iz = load(p.offset[2] + b * width);
        F reach, difference;
        D reach_squared;
        if constexpr (Kernel::unequal) {
            reach = row[7];
            difference = row[11];
            const D r = exact(reach);
            reach_squared = r * r;
        } else {
            reach = broadcast(2 * c.radius);
            difference = broadcast(0.0f);
            reach_squared = broadcast(c.reach_squared);
        }
        const F near = closeness(c, ix, iy, iz, reach_squared);
        const F square = max(single(reach_squared) - near, broadcast(1e-12f));
        Meeting<Kernel, Partner::particle> m;
        m.time_step = broadcast(f.history_step);
        m.touching = may_touch<Kernel>(near);
        const F inverse_distance = inverse_root(square);
        m.overlap = near * inverse(fma(square, inverse_distance, reach));
        m.normal = {single(ix) * (inverse_distance * broadcast(c.unit_single[0])),
                    single(iy) * (inverse_distance * broadcast(c.unit_single[1])),
                    single(iz) * (inverse_distance * broadcast(c.unit_single[2]))};
        m.velocity = {row[0], row[1], row[2]};
        const F shortening = half * m.overlap;
        F arm_first, arm_second;
        const V3 spin{row[4], row[5], row[6]};
        if constexpr (Kernel::unequal) {
            m.surface = {fnma(shortening, spin.x, row[8]), fnma(shortening, spin.y, row[9]),
                         fnma(shortening, spin.z, row[10])};
            arm_first = fms(half, reach + difference, shortening);
            arm_second = fms(half, reach - difference, shortening);
            const F product = (reach - difference) * (reach + difference);  // 4 R_i R_j
            m.root_radius = half * product * inverse_root(product * reach);
            largest_overlap = max(keep(m.touching, m.overlap * inverse(reach - abs(difference))), largest_overlap);
        } else {
            arm_first = broadcast(c.radius) - shortening;
            arm_second = arm_first;
            m.surface = spin * arm_first;
            m.root_radius = broadcast(c.root_radius);
            largest_overlap = max(keep(m.touching, m.overlap), largest_overlap);  // the diameter is 1
        }
        m.closeness = near;
        m.inverse_distance = inverse_distance;
        m.difference = difference;
        m.inverse_masses = row[3];
        if constexpr (Kernel::holds) {
            m.with_clumps = f.mobility != nullptr;
            if (m.with_clumps) [[unlikely]]
                m.inverse_masses = inverse_masses(f.mobility, first, second, m.normal);
        }
        if constexpr (Kernel::rolls) {
            F spin_row[4];
            load_spin_difference(f.records, first, second, spin_row);
            m.turning = {spin_row[0], spin_row[1], spin_row[2]};
            m.rolling_inertia = inverse(sum_of_turning_masses(f.records, first, second));
        }
        F memory[Kernel::histories + 1];
        if constexpr (streams)
            for (int a = 0; a < Kernel::histories; ++a) memory[a] = load(p.memory[a] + b * width);
        else
            load_memory<Kernel>(f.history_next, at + b * width, memory);
        const auto [force, turn, rolling] = respond(laws.of(f, first, second), m, memory);
        if constexpr (streams)
            for (int a = 0; a < Kernel::histories; ++a) stream(f.history_next[a] + at + b * width, memory[a]);
        else
            store_memory<Kernel>(f.history_next, at + b * width, memory);
        store(p.outcome[b][0], force.x);
        store(p.outcome[b][1], force.y);
        store(p.outcome[b][2], force.z);
        if constexpr (Kernel::spin) {
            store(p.outcome[b][3], turn.x * arm_first);
            store(p.outcome[b][4], turn.y * arm_first);
            store(p.outcome[b][5], turn.z * arm_first);
            if constexpr (Kernel::unequal) {
                store(p.outcome[b][6], turn.x * arm_second);
                store(p.outcome[b][7], turn.y * arm_second);
                store(p.outcome[b][8], turn.z * arm_second);
            }
            if constexpr (Kernel::rolls) {
                store(p.outcome[b][3], fms(turn.x, arm_first, rolling.x));
                store(p.outcome[b][4], fms(turn.y, arm_first, rolling.y));
                store(p.outcome[b][5], fms(turn.z, arm_first, rolling.z));
                store(p.outcome[b][6], fma(turn.x, arm_second, rolling.x));
                store(p.outcome[b][7], fma(turn.y, arm_second, rolling.y));
                store(p.outcome[b][8], fma(turn.z, arm_second, rolling.z));
            }
        }
    }
    t.overlap = largest(largest_overlap);
}

template <class Kernel>
GRAINSWEEP_PHASE void scatter(const Field& f, const Packed& p, int batches) {
    for (int b = 0; b < batches; ++b) {
        F o[9];
        for (int r = 0; r < (Kernel::spin ? (Kernel::unequal ? 9 : 6) : 3); ++r) o[r] = load(p.outcome[b][r]);
        const Place* first = p.first + b * width;
        const Place* second = p.second + b * width;
        if constexpr (!Kernel::spin) {
            scatter_forces(f.forces, first, second, o);
        } else if constexpr (Kernel::unequal) {
            scatter_unequal(f.forces, first, second, o, o + 3, o + 6);
        } else {
            scatter_pairs(f.forces, first, second, o, o + 3);
        }
    }
}

/// Pads the last vector with a pair that never touches.
GRAINSWEEP_LANES void fill_up(const Field& f, Packed& p, int packed) {
    for (int q = packed; q < packed + width; ++q) {
        p.first[q] = static_cast<Place>(f.filler * places_per_index);
        p.second[q] = static_cast<Place>((f.filler + 1) * places_per_index);
        for (auto& offset : p.offset) offset[q] = INT32_MIN;
    }
}

/// Moves the remainder of a tile to the front.
template <class Kernel, bool streams>
GRAINSWEEP_LANES void keep_rest(Packed& p, int from) {
    if constexpr (streams)
        for (int a = 0; a < Kernel::histories; ++a) store(p.memory[a], load(p.memory[a] + from));
    store(p.first, load(p.first + from));
    store(p.second, load(p.second + from));
    for (auto& offset : p.offset) store(offset, load(offset + from));
}

/// Prefetches the memory that is written after the sweep, in proportion to the progress of the sweep.
GRAINSWEEP_LANES void fetch_what_is_written_after(const Field& f, std::int32_t batch, std::int32_t batches,
                                                  std::int32_t& fetched) {
    const std::int32_t all = f.lines_written_after;
    const std::int32_t until =
        batch < batches ? static_cast<std::int32_t>(static_cast<std::int64_t>(all) * batch / batches) : all;
    for (; fetched < until; ++fetched)
        prefetch_to_write(f.written_after + static_cast<std::int64_t>(cache_line) * fetched);
}

template <class Kernel, bool streams, bool several>
void sweep_pairs(const Field& f, bool advancing, Tally& t) {
    Packed p;
    Progress at{};
    at.done = f.begin;
    const PairLaws<Kernel, several> laws(f);
    const std::int32_t batches = f.inner_count / width;
    std::int32_t fetched = 0;
    for (bool last = false; !last;) {
        sift<Kernel, streams>(f, batches, p, at);
        last = at.packed < tile;
        if (last) fill_up(f, p, at.packed);
        if (f.lines_written_after != 0) fetch_what_is_written_after(f, at.batch, batches, fetched);
        const int full = (last ? at.packed + width - 1 : at.packed) / width;
        meet<Kernel, streams, several>(f, laws, p, full, at.met, t);
        scatter<Kernel>(f, p, full);
        at.met += full * width;
        at.packed = last ? 0 : at.packed - full * width;
        keep_rest<Kernel, streams>(p, full * width);
        if (!advancing) continue;
        // the next pair is the first one left over, or else the next one listed
        const Place next = at.packed > 0 ? p.first[0] : f.inner_first[static_cast<std::int64_t>(at.batch) * width];
        const auto first = static_cast<std::int32_t>(next / places_per_index);
        // copies of other subdomains' particles lie behind the fillers, and come first in a list
        const std::int32_t until = last || first == f.filler ? f.end : first > f.filler ? at.done : first;
        advance_range<Kernel>(f, at.done, until, t);
        at.done = until;
    }
    if constexpr (streams) flush_streams();
}

template <class Kernel, bool several>
void sweep(const Field& f, bool advancing, Tally& t) {
    const auto denormals = flush_denormals();
    if (Kernel::histories > 0 && f.streams != 0)
        sweep_pairs<Kernel, (Kernel::histories > 0), several>(f, advancing, t);
    else
        sweep_pairs<Kernel, false, several>(f, advancing, t);
    restore_denormals(denormals);
}

}  // namespace
}  // namespace grainsweep::dem::fast
