// The two lists. Outer: all pairs closer than contact plus a wide skin, found through cells, sorted by the first
// particle (the particles themselves are sorted by cell). Inner: pairs of the outer list that may touch soon. Both
// tests keep doubtful pairs. Pairs of two frozen particles are never listed. The files of the instruction paths include
// this file; it has internal linkage on purpose.
#pragma once

#include "solver/dem/fast/contact.hpp"

namespace grainsweep::dem::fast {
namespace {

constexpr float rounding_allowance = 1 + 4e-6f;  // of squared distances in single precision

/// Runs of sorted particles in the neighbour cells that follow a cell in order.
struct Runs {
    std::int32_t begin[64], end[64];
    int count;
};

/// Writes the neighbour coordinates of c along an axis of n cells, each once.
GRAINSWEEP_LANES int around(std::int32_t c, std::int32_t n, bool wraps, std::int32_t* out) {
    int k = 0;
    for (std::int32_t d = -1; d <= 1; ++d) {
        std::int32_t a = c + d;
        if (a < 0 || a >= n) {
            if (!wraps) continue;
            a += a < 0 ? n : -n;
        }
        bool seen = a < 0 || a >= n;
        for (int q = 0; q < k; ++q) seen = seen || out[q] == a;
        if (!seen) out[k++] = a;
    }
    return k;
}

GRAINSWEEP_LANES void append(Runs& r, const std::int32_t* start, std::int32_t from, std::int32_t to) {
    const std::int32_t a = start[from], b = start[to + 1];
    if (a == b) return;
    if (r.count > 0 && r.end[r.count - 1] == a) {
        r.end[r.count - 1] = b;
    } else {
        r.begin[r.count] = a;
        r.end[r.count++] = b;
    }
}

/// Adds the runs of the neighbour cells after cell (x, y, z).
inline void following(const Field& f, std::int32_t x, std::int32_t y, std::int32_t z, Runs& r) {
    const std::int32_t nx = f.cells[0], ny = f.cells[1];
    const std::int32_t own = (z * ny + y) * nx + x;
    std::int32_t xs[3], ys[3], zs[3];
    const int kx = around(x, nx, f.wraps[0] != 0, xs), ky = around(y, ny, f.wraps[1] != 0, ys),
              kz = around(z, f.cells[2], f.wraps[2] != 0, zs);
    r.count = 0;
    for (int c = 0; c < kz; ++c)
        for (int b = 0; b < ky; ++b) {
            const std::int32_t row = (zs[c] * ny + ys[b]) * nx;
            for (int a = 0; a < kx; ++a)
                if (row + xs[a] > own) append(r, f.cell_start, row + xs[a], row + xs[a]);
        }
}

template <bool unequal>
std::int64_t search(const Field& f, float skin) {
    const auto denormals = flush_denormals();
    const Constants& c = f.constants;
    std::int64_t n = 0;
    Runs runs;
    I lane_places = lane_numbers();
    for (int d = 1; d < places_per_index; d *= 2) lane_places = lane_places + lane_places;
    const std::int32_t nx = f.cells[0], ny = f.cells[1];
    std::int32_t x = f.cell_begin % nx, y = f.cell_begin / nx % ny, z = f.cell_begin / nx / ny;
    const auto next = [&] {
        if (++x < nx) return;
        x = 0;
        if (++y < ny) return;
        y = 0;
        ++z;
    };
    for (std::int32_t cell = f.cell_begin; cell < f.cell_end; ++cell, next()) {
        const std::int32_t end = f.cell_start[cell + 1];
        if (f.cell_start[cell] == end) continue;
        following(f, x, y, z, runs);
        for (std::int32_t i = f.cell_start[cell]; i < end; ++i) {
            f.row[i] = static_cast<std::int32_t>(n);
            const I xi = broadcast(f.column[0][i]), yi = broadcast(f.column[1][i]), zi = broadcast(f.column[2][i]);
            const I own = broadcast(i * places_per_index);
            const F radius = broadcast(f.column_radius[i]), mobile = broadcast(f.column_mobile[i]);
            const auto scan = [&](std::int32_t from, std::int32_t to) __attribute__((always_inline)) {
                for (std::int32_t j = from; j < to; j += width) {
                    const F dx = single(xi - load(f.column[0] + j)) * broadcast(c.unit_single[0]),
                            dy = single(yi - load(f.column[1] + j)) * broadcast(c.unit_single[1]),
                            dz = single(zi - load(f.column[2] + j)) * broadcast(c.unit_single[2]);
                    const F sum = radius + load(f.column_radius + j);
                    const F cut = sum + broadcast(skin);
                    const M close = fma(dx, dx, fma(dy, dy, dz * dz)) < cut * cut * broadcast(rounding_allowance);
                    const M moves = broadcast(0.0f) < mobile + load(f.column_mobile + j);
                    unsigned found = bits(close & moves);
                    if (to - j < width) found &= (1u << (to - j)) - 1;
                    const int k = __builtin_popcount(found);
                    if (n + 2 * width <= f.outer_capacity) {
                        store(f.outer_second + n, compress(lane_places + broadcast(j * places_per_index), found));
                        store(f.outer_first + n, own);
                        if constexpr (unequal) store(f.outer_reach + n, compress(sum, found));
                    }
                    n += k;
                }
            };
            // the run of the cell itself continues into the next cell if that is a neighbour
            int first = 0;
            std::int32_t own_end = end;
            if (runs.count > 0 && runs.begin[0] == end) own_end = runs.end[first++];
            scan(i + 1, own_end);
            for (int r = first; r < runs.count; ++r) scan(runs.begin[r], runs.end[r]);
        }
    }
    restore_denormals(denormals);
    return n;
}

template <bool unequal>
std::int32_t refresh(const Field& f, float skin) {
    const auto denormals = flush_denormals();
    const Constants& c = f.constants;
    std::int64_t n = 0;
    const float cut = 2 * c.radius + skin;
    const std::int32_t batches = (f.outer_count + width - 1) / width;
    for (std::int32_t b = 0; b < batches; ++b) {
        const std::int64_t k = static_cast<std::int64_t>(b) * width;
        if (f.read_ahead != 0)
            for (int q = 0; q < width; ++q) prefetch(record_at(f.records, f.outer_second[k + q + 64]));
        I ix, iy, iz;
        load_offsets(f.records, f.outer_first + k, f.outer_second + k, ix, iy, iz);
        const F x = single(ix) * broadcast(c.unit_single[0]), y = single(iy) * broadcast(c.unit_single[1]),
                z = single(iz) * broadcast(c.unit_single[2]);
        F limit = broadcast(cut * cut * rounding_allowance), reach;
        if constexpr (unequal) {
            reach = load(f.outer_reach + k);
            reach = reach + broadcast(c.beyond);
            const F far = reach + broadcast(skin);
            limit = far * far * broadcast(rounding_allowance);
            reach = reach * reach * broadcast(rounding_allowance);
        }
        const unsigned touches = f.outer_touching[b];
        const unsigned kept = bits(fma(x, x, fma(y, y, z * z)) < limit) | touches;
        store(f.inner_first + n, compress(load(f.outer_first + k), kept));
        store(f.inner_second + n, compress(with_sign_bits(load(f.outer_second + k), touches), kept));
        store(f.inner_source + n, compress(lane_numbers() + broadcast(static_cast<std::int32_t>(k)), kept));
        if constexpr (unequal) store(f.inner_reach + n, compress(reach, kept));
        n += __builtin_popcount(kept);
    }
    const std::int64_t padded = (n + width - 1) / width * width;
    for (std::int64_t k = n; k < padded + 2 * tile; ++k) {
        f.inner_first[k] = static_cast<Place>(f.filler * places_per_index);
        f.inner_second[k] = static_cast<Place>((f.filler + 1) * places_per_index);
        if constexpr (unequal) f.inner_reach[k] = 0;
    }
    // the bits of touching pairs were stored in the sign of the second index: remove them
    for (std::int64_t k = 0; k < padded; k += width) {
        const I second = load(f.inner_second + k);
        f.touching[k / width] = static_cast<std::uint16_t>(sign_bits(second));
        store(f.inner_second + k, second & broadcast(INT32_MAX));
    }
    restore_denormals(denormals);
    return static_cast<std::int32_t>(padded);
}

}  // namespace
}  // namespace grainsweep::dem::fast
