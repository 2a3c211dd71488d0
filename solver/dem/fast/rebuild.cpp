#include "solver/dem/fast/rebuild.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "solver/dem/fast/resting.hpp"
#include "solver/dem/fast/wall_lists.hpp"

namespace grainsweep::dem::fast {

namespace {

Place place_of(std::int32_t index) {
    return static_cast<Place>(index * places_per_index);
}
std::int32_t index_of(Place place) {
    return static_cast<std::int32_t>(place / places_per_index);
}

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

/// Cells no smaller than a listed distance, few enough for the particles there are, the longest axis slowest so that
/// neighbours lie close in memory.
Grid make_grid(const Field& f, const ListSpace& space) {
    Grid g;
    const double cut = (1.0 + space.skin + f.constants.beyond) * (1 + 1e-5);
    for (int a = 0; a < 3; ++a) {
        const double unit = f.constants.unit[a];
        Axis& axis = g.axis[a];
        double span = unit * 4294967296.0;
        if (space.domain.periodic[static_cast<std::size_t>(a)]) {
            axis.origin = 0x80000000U;
        } else {
            std::int32_t low = INT32_MAX, high = INT32_MIN;
            for (std::int32_t i = 0; i < f.count; ++i) {
                low = std::min(low, f.records[i].position[a]);
                high = std::max(high, f.records[i].position[a]);
            }
            if (f.count == 0) low = high = 0;
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

/// Marks in `place` which particles stay (0) and which are removed (-1: left through a face, or listed); returns the
/// number that stay.
std::int32_t take_out(const Field& f, Columns& c, const ListSpace& space, std::span<const std::int32_t> ids) {
    std::vector<std::int32_t> gone(ids.begin(), ids.end());
    std::sort(gone.begin(), gone.end());
    const Faces faces(space);
    std::int32_t kept = 0;
    for (std::int32_t i = 0; i < f.count; ++i) {
        const auto k = static_cast<std::size_t>(i);
        const bool leaves =
            !faces.contain(f.records[i]) || (!gone.empty() && std::binary_search(gone.begin(), gone.end(), c.id[k]));
        c.place[k] = leaves ? -1 : 0;
        kept += leaves ? 0 : 1;
    }
    for (std::int32_t k = f.count; k < f.count + 3; ++k) c.place[static_cast<std::size_t>(k)] = -1;  // the fillers
    return kept;
}

/// Sorts by cell and fills the columns the search reads. place maps old to new indices afterwards.
void sort_particles(Field& f, Columns& c, const ListSpace& space, std::int32_t kept) {
    const auto before = static_cast<std::size_t>(f.count);
    const Grid g = make_grid(f, space);
    const auto total = static_cast<std::size_t>(g.total());
    c.cell_start.hold(total + 2);
    c.cell_start.clear(total + 2);
    for (int a = 0; a < 3; ++a) {
        f.cells[a] = g.axis[g.order[a]].cells;
        f.wraps[a] = space.domain.periodic[static_cast<std::size_t>(g.order[a])] ? 1 : 0;
    }
    for (std::size_t i = 0; i < before; ++i) {
        if (c.place[i] < 0) continue;
        c.cell_of[i] = g.cell(f.records[i]);
        ++c.cell_start[static_cast<std::size_t>(c.cell_of[i]) + 2];
    }
    for (std::size_t q = 0; q < total; ++q) c.cell_start[q + 2] += c.cell_start[q + 1];
    // cell_start[q + 1] is now where cell q begins, and becomes where it ends
    for (std::size_t i = 0; i < before; ++i) {
        if (c.place[i] < 0) continue;
        const std::int32_t to = c.cell_start[static_cast<std::size_t>(c.cell_of[i]) + 1]++;
        c.place[i] = to;
        const auto t = static_cast<std::size_t>(to);
        const Record& r = c.records[i];
        c.records_next[t] = r;
        c.residuals_next[t] = c.residuals[i];
        c.id_next[t] = c.id[i];
        for (int a = 0; a < 3; ++a) c.column[a][t] = r.position[a];
        c.column_radius[t] = r.radius;
        c.column_mobile[t] = r.inverse_mass > 0 ? 1.0F : 0.0F;
    }
    c.records.swap(c.records_next), c.residuals.swap(c.residuals_next), c.id.swap(c.id_next);
    f.count = kept;
    c.bind(f);
}

void pad_pairs(const Field& f, Columns& c) {
    for (std::size_t k = 0; k < static_cast<std::size_t>(spare); ++k) {
        const std::size_t at = static_cast<std::size_t>(f.outer_count) + k;
        c.outer_first[at] = place_of(f.count);
        c.outer_second[at] = place_of(f.count + 1);
        c.outer_reach[at] = 0;
    }
}

void find_pairs(Field& f, Columns& c, const Kernels& kernels, const ListSpace& space) {
    for (;;) {
        f.outer_capacity = static_cast<std::int32_t>(c.outer_first.capacity()) - spare;
        const std::int64_t found = kernels.search(f, space.skin + f.constants.beyond);
        if (found + spare <= f.outer_capacity) {
            f.outer_count = static_cast<std::int32_t>(found);
            break;
        }
        c.hold_lists(static_cast<std::size_t>(found) + 3 * spare);
        c.bind(f);
    }
    pad_pairs(f, c);
}

/// Calls visit(first, second, stream index, inner index) for every contact of the last step, in order.
template <class Visit>
void for_each_contact(const Field& f, std::int32_t width, Visit visit) {
    std::int32_t stream = 0;
    for (std::int32_t b = 0; b < f.inner_count / width; ++b)
        for (unsigned m = f.touching[b]; m != 0; m &= m - 1) {
            const std::int32_t k = b * width + std::countr_zero(m);
            visit(index_of(f.inner_first[k]), index_of(f.inner_second[k]), stream++, k);
        }
}

/// Gives old contact number `contact` of the particles i and j, by their old indices, its pair in the new outer list.
void claim(const Field& f, Columns& c, std::int32_t i, std::int32_t j, std::int32_t contact) {
    std::int32_t a = c.place[static_cast<std::size_t>(i)], b = c.place[static_cast<std::size_t>(j)];
    if (a < 0 || b < 0) return;
    const bool swapped = a > b;
    if (swapped) std::swap(a, b);
    for (std::int32_t o = f.row[a]; o < f.row[a + 1]; ++o)
        if (f.outer_second[o] == place_of(b)) {
            c.owner[static_cast<std::size_t>(o)] = swapped ? -(contact + 1) : contact + 1;
            return;
        }
}

/// Finds every old contact in the new outer list; returns how many there were.
std::int32_t find_owners(const Field& f, Columns& c, const Kernels& kernels) {
    c.owner.clear(static_cast<std::size_t>(f.outer_count));
    std::int32_t contacts = 0;
    for_each_contact(f, kernels.width, [&](std::int32_t i, std::int32_t j, std::int32_t stream, std::int32_t) {
        claim(f, c, i, j, stream);
        contacts = stream + 1;
    });
    return contacts;
}

/// Appends the parked contacts to the live ones, of which they may become part, and decides anew what rests.
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
void carry_histories(Field& f, Columns& c, const Kernels& kernels) {
    const auto outer = static_cast<std::size_t>(f.outer_count);
    c.outer_touching.clear(outer / static_cast<std::size_t>(kernels.width) + 2);
    std::size_t to = 0;
    for (std::size_t o = 0; o < outer; ++o) {
        const std::int32_t owner = c.owner[o];
        if (owner == 0) continue;
        const auto batch = o / static_cast<std::size_t>(kernels.width);
        c.outer_touching[batch] =
            static_cast<std::uint16_t>(c.outer_touching[batch] | (1U << (o % static_cast<std::size_t>(kernels.width))));
        const auto from = static_cast<std::size_t>(std::abs(owner) - 1);
        for (int a = 0; a < c.histories; ++a)
            c.history_next[a][to] = (owner > 0 ? 1.0F : c.exchanged[a]) * c.history[a][from];
        ++to;
    }
    for (int a = 0; a < c.histories; ++a) c.history[a].swap(c.history_next[a]);
    c.bind(f);
}

}  // namespace

void place_fillers(Field& f) {
    for (std::int32_t k = 0; k < 3; ++k) {
        Record r{};
        r.inverse_mass = 1;
        r.inverse_radius = 1;
        if (k < 2) r.radius = r.radius_again = 1e-3F;
        if (k == 1)
            for (auto& p : r.position) p = INT32_MIN;   // half a period away
        if (k == 2) r.radius = r.radius_again = -1e6F;  // out of reach of every wall
        f.records[f.count + k] = r;
    }
    f.records[f.count + 3] = Record{};
    f.begin = 0;
    f.end = f.filler = f.count;
}

void refresh(Field& f, PairColumns& c, const Kernels& kernels, float skin, bool marked) {
    if (!marked) {
        const auto width = static_cast<std::size_t>(kernels.width);
        c.outer_touching.clear(static_cast<std::size_t>(f.outer_count) / width + 2);
        for_each_contact(f, kernels.width, [&](std::int32_t, std::int32_t, std::int32_t, std::int32_t k) {
            const auto o = static_cast<std::size_t>(f.inner_source[k]);
            c.outer_touching[o / width] = static_cast<std::uint16_t>(c.outer_touching[o / width] | (1U << (o % width)));
        });
    }
    f.inner_count = kernels.refresh(f, skin);
}

void rebuild(Field& f, Columns& c, const Kernels& kernels, const ListSpace& space, const Walls& walls,
             std::span<const std::int32_t> ids, Resting* resting, std::int64_t steps) {
    if (resting != nullptr) resting->compare_forces(f, steps);
    const std::int32_t kept = take_out(f, c, space, ids);
    sort_particles(f, c, space, kept);
    place_fillers(f);
    find_pairs(f, c, kernels, space);
    const std::int32_t contacts = find_owners(f, c, kernels);
    if (resting != nullptr) update_resting(f, c, space, *resting, contacts);
    carry_histories(f, c, kernels);
    list_wall_contacts(f, c, kernels, space, walls, true);
}

}  // namespace grainsweep::dem::fast
