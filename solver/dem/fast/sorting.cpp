#include "solver/dem/fast/sorting.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace grainsweep::dem::fast {

namespace {

/// Cells along one axis: of periodic ones a whole number fills the period, open ones start at the lowest particle.
struct Axis {
    std::int32_t cells = 1;
    std::uint32_t origin = 0;
    double per_unit = 0;  ///< cells per position unit

    [[nodiscard]] std::int32_t of(std::int32_t position) const {
        const auto from_origin = static_cast<std::uint32_t>(position) - origin;
        const auto cell = static_cast<std::int32_t>(static_cast<double>(from_origin) * per_unit);
        return cell < cells ? cell : cells - 1;
    }
};

struct Grid {
    Axis axis[3];
    int order[3] = {0, 1, 2};  ///< fast, middle, slow axis

    [[nodiscard]] std::int32_t cell(const Record& r) const {
        const Axis &a = axis[order[0]], &b = axis[order[1]], &c = axis[order[2]];
        return (c.of(r.position[order[2]]) * b.cells + b.of(r.position[order[1]])) * a.cells +
               a.of(r.position[order[0]]);
    }
    [[nodiscard]] std::int64_t total() const { return std::int64_t{axis[0].cells} * axis[1].cells * axis[2].cells; }
};

/// Lowest and highest position along an axis.
std::pair<std::int32_t, std::int32_t> extent(const Field& f, int axis, const Parts& parts) {
    if (f.count == 0) return {0, 0};
    std::vector<std::pair<std::int32_t, std::int32_t>> of_part(static_cast<std::size_t>(parts.count()));
    parts.run([&](int part) {
        std::int32_t low = INT32_MAX, high = INT32_MIN;
        const Range range = parts.share(part, f.count);
        for (std::int32_t i = range.begin; i < range.end; ++i) {
            low = std::min(low, f.records[i].position[axis]);
            high = std::max(high, f.records[i].position[axis]);
        }
        of_part[static_cast<std::size_t>(part)] = {low, high};
    });
    auto all = of_part.front();
    for (const auto& [low, high] : of_part) all = {std::min(all.first, low), std::max(all.second, high)};
    return all;
}

/// Cells no smaller than a listed distance, few enough for the particles there are, the longest axis slowest so that
/// neighbours lie close in memory.
Grid make_grid(const Field& f, const ListSpace& space, const Parts& parts) {
    Grid g;
    const double cut = (1.0 + space.skin + f.constants.beyond) * (1 + 1e-5);
    for (int a = 0; a < 3; ++a) {
        const double unit = f.constants.unit[a];
        Axis& axis = g.axis[a];
        double span = unit * 4294967296.0;
        if (space.domain.periodic[static_cast<std::size_t>(a)]) {
            axis.origin = 0x80000000U;
        } else {
            const auto [low, high] = extent(f, a, parts);
            axis.origin = static_cast<std::uint32_t>(low);
            span = unit * (static_cast<double>(high) - static_cast<double>(low) + 1);
        }
        axis.cells = std::max(1, static_cast<std::int32_t>(std::min(span / cut, 1e6)));
        axis.per_unit = axis.cells / span * unit;
    }
    while (g.total() > 8 * std::int64_t{f.count} + 512) {
        Axis& longest =
            *std::max_element(g.axis, g.axis + 3, [](const Axis& a, const Axis& b) { return a.cells < b.cells; });
        longest.per_unit *= static_cast<double>(longest.cells / 2) / longest.cells;
        longest.cells /= 2;
    }
    std::stable_sort(g.order, g.order + 3, [&](int a, int b) { return g.axis[a].cells < g.axis[b].cells; });
    return g;
}

/// Position units between which a centre is inside.
struct Faces {
    std::int32_t low[3], high[3];

    explicit Faces(const ListSpace& space) {
        for (std::size_t a = 0; a < 3; ++a) {
            const bool open = !space.domain.periodic[a];
            low[a] = open ? static_cast<std::int32_t>(space.scale.units(space.domain.low[a], a)) : INT32_MIN;
            high[a] = open ? static_cast<std::int32_t>(space.scale.units(space.domain.high[a], a)) : INT32_MAX;
        }
    }
    [[nodiscard]] bool contain(const Record& r) const {
        bool inside = true;
        for (int a = 0; a < 3; ++a) inside = inside && r.position[a] >= low[a] && r.position[a] <= high[a];
        return inside;
    }
};

/// Computes, for each part and cell, the place of the part's next particle: the number of particles in earlier cells,
/// and of earlier parts in this cell. Sets c.cell_start to the start of each cell.
void place_cells(Columns& c, std::int32_t cells, const Parts& parts) {
    const auto stride = static_cast<std::size_t>(cells);
    const auto each_part = [&](auto&& visit) {
        for (std::size_t p = 0; p < static_cast<std::size_t>(parts.count()); ++p) visit(p * stride);
    };
    const std::vector<std::int32_t> before = parts.counted(cells, [&](Range range) {
        std::int32_t sum = 0;
        each_part([&](std::size_t of) {
            for (std::int32_t q = range.begin; q < range.end; ++q)
                sum += c.cell_counts[of + static_cast<std::size_t>(q)];
        });
        return sum;
    });
    parts.run([&](int part) {
        std::int32_t next = before[static_cast<std::size_t>(part)];
        const Range range = parts.share(part, cells);
        for (std::int32_t q = range.begin; q < range.end; ++q) {
            const auto cell = static_cast<std::size_t>(q);
            c.cell_start[cell] = next;
            each_part([&](std::size_t of) {
                const std::int32_t count = c.cell_counts[of + cell];
                c.cell_counts[of + cell] = next;
                next += count;
            });
        }
    });
    c.cell_start[stride] = before.back();
}

}  // namespace

std::int32_t take_out(const Field& f, Columns& c, const ListSpace& space, std::span<const std::int32_t> ids,
                      const Parts& parts) {
    std::vector<std::int32_t> gone(ids.begin(), ids.end());
    std::sort(gone.begin(), gone.end());
    const Faces faces(space);
    const std::vector<std::int32_t> kept = parts.counted(f.count, [&](Range range) {
        std::int32_t stay = 0;
        for (std::int32_t i = range.begin; i < range.end; ++i) {
            const auto k = static_cast<std::size_t>(i);
            const bool leaves = !faces.contain(f.records[i]) ||
                                (!gone.empty() && std::binary_search(gone.begin(), gone.end(), c.id[k]));
            c.place[k] = leaves ? -1 : 0;
            stay += leaves ? 0 : 1;
        }
        return stay;
    });
    for (std::int32_t k = f.count; k < f.count + fillers; ++k) c.place[static_cast<std::size_t>(k)] = -1;
    return kept.back();
}

void sort_particles(Field& f, Columns& c, const ListSpace& space, std::int32_t kept, const Parts& parts) {
    const Grid g = make_grid(f, space, parts);
    const auto total = static_cast<std::size_t>(g.total());
    c.cell_start.hold(total + 1);
    c.cell_counts.hold(total * static_cast<std::size_t>(parts.count()));
    for (int a = 0; a < 3; ++a) {
        f.cells[a] = g.axis[g.order[a]].cells;
        f.wraps[a] = space.domain.periodic[static_cast<std::size_t>(g.order[a])] ? 1 : 0;
    }
    parts.run([&](int part) {
        std::int32_t* const counts = c.cell_counts.data() + total * static_cast<std::size_t>(part);
        std::fill_n(counts, total, 0);
        const Range range = parts.share(part, f.count);
        for (auto i = static_cast<std::size_t>(range.begin); i < static_cast<std::size_t>(range.end); ++i) {
            if (c.place[i] < 0) continue;
            c.cell_of[i] = g.cell(f.records[i]);
            ++counts[c.cell_of[i]];
        }
    });
    place_cells(c, static_cast<std::int32_t>(total), parts);
    parts.run([&](int part) {
        std::int32_t* const next = c.cell_counts.data() + total * static_cast<std::size_t>(part);
        const Range range = parts.share(part, f.count);
        for (auto i = static_cast<std::size_t>(range.begin); i < static_cast<std::size_t>(range.end); ++i) {
            if (c.place[i] < 0) continue;
            const std::int32_t to = next[c.cell_of[i]]++;
            c.place[i] = to;
            const auto t = static_cast<std::size_t>(to);
            const Record& r = c.records[i];
            c.records_next[t] = r;
            if (c.residuals_apart)
                c.residuals_next[t] = c.residuals[i];
            else
                c.forces_next[t] = c.forces[i];
            c.id_next[t] = c.id[i];
            c.kind_next[t] = c.kind[i];
            for (int a = 0; a < 3; ++a) c.column[a][t] = r.position[a];
            c.column_radius[t] = r.radius;
            c.column_mobile[t] = r.inverse_mass > 0 ? 1.0F : 0.0F;
        }
    });
    c.records.swap(c.records_next), c.id.swap(c.id_next), c.kind.swap(c.kind_next);
    if (c.residuals_apart)
        c.residuals.swap(c.residuals_next);
    else
        c.forces.swap(c.forces_next);
    f.count = kept;
    c.bind(f);
}

}  // namespace grainsweep::dem::fast
