#include "sweep/report/film.hpp"

#include "stats/random.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace grainsweep::report {
namespace {

constexpr float absent = std::numeric_limits<float>::quiet_NaN();
constexpr std::uint64_t thinning_stream = 1;

using Vector = std::array<double, 3>;

double magnitude(const Vector& v) {
    return std::hypot(v[0], v[1], v[2]);
}

/// Returns whether a column is a fixed property of a sphere, not a part of its state.
bool is_trait(std::string_view name) {
    return name == "id" || name == "mobile" || name == "diameter";
}

bool same_shape(const WallSurface& a, const WallSurface& b) {
    return a.name == b.name && a.corners.size() == b.corners.size() && a.triangles == b.triangles && a.edges == b.edges;
}

}  // namespace

/// Returns the place of each particle of the snapshot in the frames; `spheres_.size()` for a particle that is left out.
std::vector<std::size_t> Film::places_of(const Snapshot& snapshot) {
    const std::size_t n = snapshot.positions.size();
    const auto ids = snapshot.scalars.find("id");
    const auto diameters = snapshot.scalars.find("diameter");
    const auto mobile = snapshot.scalars.find("mobile");
    const auto given = [&](const auto& column) { return column != snapshot.scalars.end(); };
    if (frames_.empty() && n > limits_.spheres)
        kept_share_ = static_cast<double>(limits_.spheres) / static_cast<double>(n);
    most_present_ = std::max(most_present_, n);
    const stats::Stream thinning(0, thinning_stream);
    std::vector<std::size_t> places(n, std::numeric_limits<std::size_t>::max());
    for (std::size_t i = 0; i < n; ++i) {
        const auto id = given(ids) ? static_cast<std::int64_t>(ids->second[i]) : static_cast<std::int64_t>(i);
        if (kept_share_ < 1 && thinning.uniform(static_cast<std::uint64_t>(id)) >= kept_share_) continue;
        const auto [found, is_new] = place_of_.try_emplace(id, spheres_.size());
        if (is_new)
            spheres_.push_back({given(diameters) ? diameters->second[i] : 0, !given(mobile) || mobile->second[i] != 0});
        places[i] = found->second;
    }
    return places;
}

void Film::add_particles(const Snapshot& snapshot) {
    const auto check = [&](const auto& columns) {
        for (const auto& [name, values] : columns)
            if (values.size() != snapshot.positions.size())
                throw std::invalid_argument(fmt::format("column '{}' of a picture has {} values for {} particles", name,
                                                        values.size(), snapshot.positions.size()));
    };
    check(snapshot.scalars);
    check(snapshot.vectors);
    const auto places = places_of(snapshot);
    Frame frame;
    frame.positions.assign(spheres_.size(), {absent, absent, absent});
    const auto fill = [&](const std::string& name, auto value) {
        auto& column = frame.columns[name];
        column.assign(spheres_.size(), absent);
        for (std::size_t i = 0; i < places.size(); ++i)
            if (places[i] < column.size()) column[places[i]] = static_cast<float>(value(i));
    };
    for (std::size_t i = 0; i < places.size(); ++i) {
        if (places[i] >= spheres_.size()) continue;
        for (std::size_t a = 0; a < 3; ++a)
            frame.positions[places[i]][a] = static_cast<float>(snapshot.positions[i][a]);
    }
    for (const auto& [name, values] : snapshot.scalars)
        if (limits_.columns && !is_trait(name)) fill(name, [&values = values](std::size_t i) { return values[i]; });
    for (const auto& [name, values] : snapshot.vectors)
        if (limits_.columns || name == "velocity")
            fill(name, [&values = values](std::size_t i) { return magnitude(values[i]); });
    if (limits_.forces && snapshot.contacts) add_forces(snapshot, frame);
    frames_.push_back(std::move(frame));
}

/// Adds the contacts of two shown particles, ordered by their places.
void Film::add_forces(const Snapshot& snapshot, Frame& frame) const {
    const auto& columns = snapshot.contacts->scalars;
    const auto first = columns.find("first"), second = columns.find("second"), force = columns.find("normal_force");
    if (first == columns.end() || second == columns.end() || force == columns.end()) return;
    const auto place = [&](double id) { return place_of_.find(static_cast<std::int64_t>(id)); };
    for (std::size_t k = 0; k < force->second.size(); ++k) {
        const auto a = place(first->second[k]), b = place(second->second[k]);  // a wall is no particle
        if (a == place_of_.end() || b == place_of_.end()) continue;
        const auto [low, high] = std::minmax(a->second, b->second);
        frame.forces.push_back({low, high, force->second[k]});
    }
    std::ranges::sort(frame.forces, {}, [](const Force& one) { return std::pair(one.first, one.second); });
}

void Film::add_walls(const Snapshot& snapshot) {
    for (auto& wall : walls_) {
        if (wall.closed) continue;
        const auto now =
            std::ranges::find_if(snapshot.walls, [&](const WallSurface& seen) { return same_shape(seen, wall.shape); });
        wall.closed = now == snapshot.walls.end();
        if (wall.closed) continue;
        wall.moves = wall.moves || now->corners != wall.shape.corners;
        wall.corners.push_back(now->corners);
    }
    for (const auto& seen : snapshot.walls) {
        const bool known =
            std::ranges::any_of(walls_, [&](const Wall& wall) { return !wall.closed && same_shape(seen, wall.shape); });
        if (!known && !seen.corners.empty()) walls_.push_back({seen, times_.size(), {seen.corners}, false, false});
    }
}

Film::Slice& Film::slice_of(const FlowField& field, const std::string& quantity, int component) {
    const auto found = std::ranges::find_if(slices_, [&](const Slice& slice) {
        return slice.field == field.name && slice.quantity == quantity && slice.component == component;
    });
    if (found != slices_.end()) return *found;
    return slices_.emplace_back(Slice{field.name, quantity, component, field.faces});
}

namespace {

/// Calls body(cell) for the cells of a plane across `axis`. u and v are the other two axes in their order; u varies
/// fastest.
template <class Body>
void for_each_cell_of_plane(const std::array<std::size_t, 3>& cells, std::size_t axis, std::size_t at, Body body) {
    const std::size_t u = axis == 0 ? 1 : 0;
    const std::size_t v = axis == 2 ? 1 : 2;
    std::array<std::size_t, 3> index{};
    index[axis] = at;
    for (index[v] = 0; index[v] < cells[v]; ++index[v])
        for (index[u] = 0; index[u] < cells[u]; ++index[u])
            body(index[0] + cells[0] * (index[1] + cells[1] * index[2]));
}

/// The mean of the two planes of cells beside the middle of the box, or its middle plane of cells.
template <class Value>
std::vector<float> middle_plane(const FlowField& field, std::size_t axis, Value value) {
    std::array<std::size_t, 3> cells{};
    for (std::size_t a = 0; a < 3; ++a) cells[a] = field.faces[a].size() - 1;
    std::vector<float> plane;
    for_each_cell_of_plane(cells, axis, cells[axis] / 2,
                           [&](std::size_t cell) { plane.push_back(static_cast<float>(value(cell))); });
    if (cells[axis] % 2 == 0) {
        std::size_t k = 0;
        for_each_cell_of_plane(cells, axis, cells[axis] / 2 - 1, [&](std::size_t cell) {
            plane[k] = 0.5F * (plane[k] + static_cast<float>(value(cell)));
            ++k;
        });
    }
    return plane;
}

}  // namespace

void Film::add_slices(const FlowField& field) {
    const auto add = [&](const std::string& quantity, int component, auto value) {
        Slice& slice = slice_of(field, quantity, component);
        if (slice.faces != field.faces || slice.frames != times_.size()) return;  // a quantity that comes and goes
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto plane = middle_plane(field, axis, value);
            slice.planes[axis].insert(slice.planes[axis].end(), plane.begin(), plane.end());
        }
        ++slice.frames;
    };
    for (const auto& [name, values] : field.vectors) {
        add(name, 3, [&values = values](std::size_t cell) { return magnitude(values[cell]); });
        for (int c = 0; c < 3; ++c)
            add(name, c, [&values = values, c](std::size_t cell) { return values[cell][static_cast<std::size_t>(c)]; });
    }
    for (const auto& [name, values] : field.scalars)
        add(name, -1, [&values = values](std::size_t cell) { return values[cell]; });
}

void Film::add(const Snapshot& snapshot, double time) {
    units_ = snapshot.units;
    length_unit_ = snapshot.length_unit;
    time_unit_ = snapshot.time_unit;
    periods_ = snapshot.periods;
    add_particles(snapshot);
    add_walls(snapshot);
    for (const auto& field : snapshot.fields) add_slices(field);
    times_.push_back(time);
}

namespace {

/// Keeps the equally long parts of a column at these places.
template <class Column>
Column kept_parts(Column& column, std::size_t parts, const std::vector<std::size_t>& places) {
    const auto length = static_cast<std::ptrdiff_t>(column.size() / parts);
    Column kept;
    for (const std::size_t place : places) {
        const auto begin = column.begin() + static_cast<std::ptrdiff_t>(place) * length;
        kept.insert(kept.end(), std::move_iterator(begin), std::move_iterator(begin + length));
    }
    return kept;
}

}  // namespace

void Film::keep(const std::vector<std::size_t>& frames) {
    for (Slice& slice : slices_) {
        if (slice.frames != times_.size()) continue;
        for (auto& plane : slice.planes) plane = kept_parts(plane, slice.frames, frames);
        slice.frames = frames.size();
    }
    std::vector<Wall> walls;
    for (Wall& wall : walls_) {
        std::optional<Wall> kept;
        for (std::size_t k = 0; k < frames.size(); ++k) {
            if (frames[k] < wall.first || frames[k] >= wall.first + wall.corners.size()) continue;
            const auto& corners = wall.corners[frames[k] - wall.first];
            if (!kept) {
                kept = Wall{wall.shape, k};
                kept->shape.corners = corners;
                kept->closed = wall.closed;
            }
            kept->moves = kept->moves || corners != kept->shape.corners;
            kept->corners.push_back(corners);
        }
        if (kept) walls.push_back(std::move(*kept));
    }
    walls_ = std::move(walls);
    frames_ = kept_parts(frames_, times_.size(), frames);
    times_ = kept_parts(times_, times_.size(), frames);
}

}  // namespace grainsweep::report
