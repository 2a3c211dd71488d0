#include "solver/dem/fast/rebuild.hpp"

#include "solver/dem/fast/clumps.hpp"
#include "solver/dem/fast/listed_pairs.hpp"
#include "solver/dem/fast/parts.hpp"
#include "solver/dem/fast/resting.hpp"
#include "solver/dem/fast/wall_lists.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace grainsweep::dem::fast {
namespace {

// ---- counting sort of the particles by cell

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

/// Marks in `place` the particles that stay (0) and those removed (-1: left through a face, or in `ids`). Returns the
/// number that stay.
std::int32_t take_out(const Field& f, Columns& c, const ListSpace& space, std::span<const std::int32_t> ids,
                      const Parts& parts) {
    std::vector<std::int32_t> gone(ids.begin(), ids.end());
    std::sort(gone.begin(), gone.end());
    const Faces faces(space);
    const std::vector<std::int32_t> kept = parts.counted(f.count, [&](Range range) {
        std::int32_t stay = 0;
        for (std::int32_t i = range.begin; i < range.end; ++i) {
            const auto k = static_cast<std::size_t>(i);
            const bool member = f.member != nullptr && f.member[i] >= 0;  // leaves with its body, which is in `ids`
            const bool leaves = (!member && !faces.contain(f.records[i])) ||
                                (!gone.empty() && std::binary_search(gone.begin(), gone.end(), c.id[k]));
            c.place[k] = leaves ? -1 : 0;
            stay += leaves ? 0 : 1;
        }
        return stay;
    });
    for (std::int32_t k = f.count; k < f.count + fillers; ++k) c.place[static_cast<std::size_t>(k)] = -1;
    return kept.back();
}

/// Sorts by cell, stable within a cell, and fills the columns that the search reads. Afterwards `place` maps old to new
/// indices.
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

// ---- pairs and their contacts

void pad_pairs(const Field& f, Columns& c) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(spare); ++k) {
        const std::size_t at = static_cast<std::size_t>(f.outer_count) + k;
        c.outer_first[at] = place_at(f.count);
        c.outer_second[at] = place_at(f.count + 1);
        c.outer_reach[at] = 0;
    }
}

/// Room for as many pairs as the lists say they hold; more are only counted.
std::int64_t search_within(Field& f, PairColumns& lists, const Kernels& kernels, float skin) {
    f.outer_capacity = static_cast<std::int32_t>(lists.outer_first.capacity()) - spare;
    f.outer_first = lists.outer_first.data();
    f.outer_second = lists.outer_second.data();
    f.outer_reach = lists.outer_reach.data();
    return kernels.search(f, skin);
}

void find_pairs_alone(Field& f, Columns& c, const Kernels& kernels, float skin) {
    f.cell_begin = 0;
    f.cell_end = f.cells[0] * f.cells[1] * f.cells[2];
    for (;;) {
        const std::int64_t found = search_within(f, c, kernels, skin);
        f.outer_count = static_cast<std::int32_t>(found);
        if (found + spare <= f.outer_capacity) return;
        c.hold_lists(static_cast<std::size_t>(found) + 3 * spare);
        c.bind(f);
    }
}

/// The pairs of a range of cells, into lists of the part's own.
std::int32_t find_pairs_of(const Field& whole, PairColumns& lists, Range cells, const Kernels& kernels, float skin) {
    Field f = whole;
    f.cell_begin = cells.begin;
    f.cell_end = cells.end;
    for (;;) {
        const std::int64_t found = search_within(f, lists, kernels, skin);
        if (found + spare <= f.outer_capacity) return static_cast<std::int32_t>(found);
        lists.hold_outer(static_cast<std::size_t>(found) + 3 * spare);
    }
}

/// The same list by parts: of ranges of cells with about as many particles.
void find_pairs_together(Field& f, Columns& c, const Kernels& kernels, float skin, const Parts& parts) {
    const std::int32_t all = f.cells[0] * f.cells[1] * f.cells[2];
    const auto cells_of = [&](int part) {
        const auto bound = [&](int k) {
            if (k == parts.count()) return all;
            const std::int32_t particle = parts.share(k, f.count).begin;
            return static_cast<std::int32_t>(std::lower_bound(f.cell_start, f.cell_start + all, particle) -
                                             f.cell_start);
        };
        return Range{bound(part), bound(part + 1)};
    };
    const auto estimate = static_cast<std::size_t>(f.outer_count / parts.count()) * 9 / 8 + 3 * spare;
    std::vector<std::int32_t> before(static_cast<std::size_t>(parts.count()) + 1, 0);
    parts.run([&](int part) {
        parts.lists(part).hold_outer(estimate);
        before[static_cast<std::size_t>(part) + 1] = find_pairs_of(f, parts.lists(part), cells_of(part), kernels, skin);
    });
    for (std::size_t k = 1; k < before.size(); ++k) before[k] += before[k - 1];
    f.outer_count = before.back();
    c.hold_lists(static_cast<std::size_t>(f.outer_count) + 3 * spare);
    c.bind(f);
    parts.run([&](int part) {
        const PairColumns& lists = parts.lists(part);
        const std::int32_t from = before[static_cast<std::size_t>(part)],
                           count = before[static_cast<std::size_t>(part) + 1] - from;
        std::copy_n(lists.outer_first.data(), count, f.outer_first + from);
        std::copy_n(lists.outer_second.data(), count, f.outer_second + from);
        std::copy_n(lists.outer_reach.data(), count, f.outer_reach + from);
        const Range cells = cells_of(part);
        for (std::int32_t i = f.cell_start[cells.begin]; i < f.cell_start[cells.end]; ++i) f.row[i] += from;
    });
}

/// Removes the pairs of members of one body from the outer list.
void leave_out_own_pairs(Field& f) {
    const auto body_of = [&](std::int32_t i) { return f.member[i] < 0 ? -1 : f.member_body[f.member[i]]; };
    std::int32_t to = 0;
    for (std::int32_t i = 0; i < f.count; ++i) {
        const std::int32_t begin = f.row[i], end = f.row[i + 1], body = body_of(i);
        f.row[i] = to;
        for (std::int32_t k = begin; k < end; ++k) {
            if (body >= 0 && body_of(index_at(f.outer_second[k])) == body) continue;
            f.outer_first[to] = f.outer_first[k];
            f.outer_second[to] = f.outer_second[k];
            f.outer_reach[to] = f.outer_reach[k];
            ++to;
        }
    }
    f.row[f.count] = f.outer_count = to;
}

void find_pairs(Field& f, Columns& c, const Kernels& kernels, const ListSpace& space, const Parts& parts) {
    const float skin = space.skin + f.constants.beyond;
    if (parts.count() == 1)
        find_pairs_alone(f, c, kernels, skin);
    else
        find_pairs_together(f, c, kernels, skin, parts);
    f.row[f.count] = f.outer_count;
    if (f.member != nullptr) leave_out_own_pairs(f);
    pad_pairs(f, c);
}

/// Calls visit(first, second, stream index, inner index) for every contact of the last step in these vectors of the
/// inner list, in order. `stream`: index of the first contact.
template <class Visit>
void for_each_contact(const Field& f, Range vectors, std::int32_t stream, std::int32_t width, Visit visit) {
    for (std::int32_t b = vectors.begin; b < vectors.end; ++b)
        for (unsigned m = f.touching[b]; m != 0; m &= m - 1) {
            const std::int32_t k = b * width + std::countr_zero(m);
            visit(index_at(f.inner_first[k]), index_at(f.inner_second[k]), stream++, k);
        }
}

/// Gives old contact number `contact` of the particles i and j, by their old indices, its pair in the new outer list.
void claim(const Field& f, Columns& c, std::int32_t i, std::int32_t j, std::int32_t contact) {
    std::int32_t a = c.place[static_cast<std::size_t>(i)], b = c.place[static_cast<std::size_t>(j)];
    if (a < 0 || b < 0) return;
    const bool swapped = a > b;
    if (swapped) std::swap(a, b);
    for (std::int32_t o = f.row[a]; o < f.row[a + 1]; ++o)
        if (f.outer_second[o] == place_at(b)) {
            c.owner[static_cast<std::size_t>(o)] = swapped ? -(contact + 1) : contact + 1;
            return;
        }
}

/// Finds every old contact in the new outer list; returns how many there were.
std::int32_t find_owners(const Field& f, Columns& c, const Kernels& kernels, const Parts& parts) {
    const std::int32_t vectors = f.inner_count / kernels.width;
    parts.run_shares(f.outer_count,
                     [&](Range range) { std::fill(c.owner.data() + range.begin, c.owner.data() + range.end, 0); });
    const std::vector<std::int32_t> before = parts.counted(vectors, [&](Range range) {
        std::int32_t contacts = 0;
        for (std::int32_t b = range.begin; b < range.end; ++b)
            contacts += std::popcount(static_cast<unsigned>(f.touching[b]));
        return contacts;
    });
    parts.run([&](int part) {
        for_each_contact(
            f, parts.share(part, vectors), before[static_cast<std::size_t>(part)], kernels.width,
            [&](std::int32_t i, std::int32_t j, std::int32_t stream, std::int32_t) { claim(f, c, i, j, stream); });
    });
    return before.back();
}

/// Appends the parked contacts to the live ones, because they may become live again, and decides anew which particles
/// rest.
void update_resting(Field& f, Columns& c, const ListSpace& space, Resting& resting, std::int32_t contacts) {
    auto at = static_cast<std::size_t>(contacts);
    for (int a = 0; a < c.histories; ++a) c.history[a].hold(at + resting.parked().size() + spare);
    for (const ParkedContact& p : resting.parked()) {
        for (int a = 0; a < c.histories; ++a) c.history[a][at] = p.history[a];
        claim(f, c, p.first, p.second, static_cast<std::int32_t>(at++));
    }
    resting.reorder(f, c);
    resting.update(f, c, space, contacts);
    pad_pairs(f, c);
}

/// Moves the histories of owned pairs into their new order; what saw its particles change places takes their factors.
void carry_histories(Field& f, Columns& c, const Kernels& kernels, const Parts& parts) {
    const auto width = static_cast<std::size_t>(kernels.width);
    const std::vector<std::int32_t> before = parts.counted(
        f.outer_count,
        [&](Range range) {
            return static_cast<std::int32_t>((range.end - range.begin) -
                                             std::count(c.owner.data() + range.begin, c.owner.data() + range.end, 0));
        },
        kernels.width);
    parts.run([&](int part) {
        const Range range = parts.share(part, f.outer_count, kernels.width);
        auto to = static_cast<std::size_t>(before[static_cast<std::size_t>(part)]);
        for (auto o = static_cast<std::size_t>(range.begin); o < static_cast<std::size_t>(range.end); ++o) {
            const std::size_t batch = o / width, lane = o % width;
            if (lane == 0) c.outer_touching[batch] = 0;
            const std::int32_t owner = c.owner[o];
            if (owner == 0) continue;
            c.outer_touching[batch] = static_cast<std::uint16_t>(c.outer_touching[batch] | (1U << lane));
            const auto from = static_cast<std::size_t>(std::abs(owner) - 1);
            for (int a = 0; a < c.histories; ++a)
                c.history_next[a][to] = (owner > 0 ? 1.0F : c.exchanged[a]) * c.history[a][from];
            ++to;
        }
    });
    const std::size_t vectors = (static_cast<std::size_t>(f.outer_count) + width - 1) / width;
    for (std::size_t b = vectors; b < vectors + 2; ++b) c.outer_touching[b] = 0;
    for (int a = 0; a < c.histories; ++a) c.history[a].swap(c.history_next[a]);
    c.bind(f);
}

}  // namespace

void place_fillers(Field& f) {
    for (std::int32_t k = 0; k < fillers; ++k) {
        Record r{};
        r.inverse_mass = 1;
        r.inverse_radius = 1;
        if (k < 2) r.radius = r.rest[3] = 1e-3F;
        if (k == 1)
            for (auto& p : r.position) p = INT32_MIN;  // half a period away
        if (k == 2) r.radius = r.rest[3] = -1e6F;      // out of reach of every wall
        f.records[f.count + k] = r;
    }
    f.begin = 0;
    f.end = f.filler = f.count;
    f.wall_filler = f.count + 2;
}

void refresh(Field& f, PairColumns& c, const Kernels& kernels, float skin, bool marked) {
    if (!marked) {
        const auto width = static_cast<std::size_t>(kernels.width);
        c.outer_touching.clear(static_cast<std::size_t>(f.outer_count) / width + 2);
        const auto mark = [&](std::int32_t, std::int32_t, std::int32_t, std::int32_t k) {
            const auto o = static_cast<std::size_t>(f.inner_source[k]);
            c.outer_touching[o / width] = static_cast<std::uint16_t>(c.outer_touching[o / width] | (1U << (o % width)));
        };
        for_each_contact(f, {0, f.inner_count / kernels.width}, 0, kernels.width, mark);
    }
    f.inner_count = kernels.refresh(f, skin);
}

void rebuild(Field& f, Columns& c, const Kernels& kernels, const ListSpace& space, const Walls& walls,
             std::span<const std::int32_t> ids, Resting* resting, std::int64_t steps, const Parts& parts,
             Clumps* clumps, std::size_t ids_so_far) {
    if (resting != nullptr) resting->compare_forces(f, steps);
    std::vector<std::int32_t> removed(ids.begin(), ids.end());
    if (clumps != nullptr) clumps->take_out(space.domain, removed);
    const std::int32_t kept = take_out(f, c, space, removed, parts);
    sort_particles(f, c, space, kept, parts);
    place_fillers(f);
    if (clumps != nullptr) clumps->sort(f, c, ids_so_far);
    if (clumps != nullptr && !clumps->map(f, c, kernels, ids_so_far, space.scale))
        throw std::logic_error("a clump lacks a member");
    find_pairs(f, c, kernels, space, parts);
    const std::int32_t contacts = find_owners(f, c, kernels, parts);
    if (resting != nullptr) update_resting(f, c, space, *resting, contacts);
    carry_histories(f, c, kernels, parts);
    list_wall_contacts(f, c, kernels, space, walls, true, parts);
}

}  // namespace grainsweep::dem::fast
