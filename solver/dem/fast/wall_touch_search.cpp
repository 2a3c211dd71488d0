#include <algorithm>
#include <cmath>

#include "solver/dem/fast/pieced_walls.hpp"
#include "solver/dem/fast/wall_touches.hpp"
#include "solver/geometry/contact_memory.hpp"

namespace grainsweep::dem::fast {

using namespace geometry;

namespace {

void move_touch(Columns& c, std::size_t from, std::size_t to) {
    c.touch_particle[to] = c.touch_particle[from];
    c.touch_overlap[to] = c.touch_overlap[from];
    for (int a = 0; a < 3; ++a) {
        c.touch_normal[a][to] = c.touch_normal[a][from];
        c.touch_velocity[a][to] = c.touch_velocity[a][from];
        c.touch_lever[a][to] = c.touch_lever[a][from];
    }
}

}  // namespace

void WallTouches::find(Field& f, Columns& c, const Walls& walls, const Kernels& kernels, const Scale& scale,
                       double drift, const Parts& parts) {
    if (pieced_.empty()) return;
    before_.resize(static_cast<std::size_t>(segment_.back().end));
    for (std::size_t k = 0; k < before_.size(); ++k)
        before_[k] = {c.touch_particle[k], {c.touch_normal[0][k], c.touch_normal[1][k], c.touch_normal[2][k]}};
    std::int32_t at = 0;
    std::size_t next = 0;
    for (std::size_t w = 0; w < walls.count(); ++w) {
        const WallSegment old = segment_[w];
        segment_[w].begin = at;
        if (next < pieced_.size() && pieced_[next].wall == w) {
            PieceWall& p = pieced_[next++];
            const auto near = static_cast<std::int32_t>(p.particle.size());
            // Each part finds as many as it has candidates at most, and writes whole vectors.
            const auto room = [&](int part) { return at + p.first[parts.share(part, near).begin] + part * spare; };
            scratch_.resize(std::max(scratch_.size(), static_cast<std::size_t>(parts.count())));
            const auto most = static_cast<std::size_t>(at + p.first.back() + parts.count() * spare);
            c.hold_touches(most);
            c.bind(f);
            entry_.resize(std::max(entry_.size(), most));
            piece_.resize(entry_.size());
            const Search search{
                &p, &walls[w], &f, &c, &scale, static_cast<std::size_t>(old.end), entry_.data(), piece_.data()};
            parts.run([&](int part) {
                const Range entries = parts.share(part, near);
                refresh(p, entries, f, walls[w], scale, drift);
                find_part(search, entries, static_cast<std::size_t>(old.begin), kernels,
                          scratch_[static_cast<std::size_t>(part)], room(part));
            });
            at = close_gaps(c, at, parts);
        }
        segment_[w].end = at;
    }
    for (int a = 0; a < c.histories; ++a) c.touch_memory[a].swap(c.touch_memory_next[a]);
    publish(f, c);
}

/// The contacts of some particles of a wall's list, from `at` on.
void WallTouches::find_part(const Search& s, Range entries, std::size_t old_begin, const Kernels& kernels, Scratch& own,
                            std::int32_t at) const {
    own.found = {at, at};
    if (entries.begin == entries.end) return;
    const PieceWall& p = *s.pieces;
    const auto from = static_cast<std::size_t>(entries.begin);
    const PieceList list{p.numbers.data(),
                         p.stride,
                         p.margin,
                         entries.end - entries.begin,
                         p.particle.data() + from,
                         p.first.data() + from,
                         p.active.data() + from,
                         p.candidate.data(),
                         s.entry,
                         s.piece};
    const std::int32_t found = kernels.pieces(*s.field, static_cast<std::int32_t>(p.wall), list, at);
    const Place first = p.particle[from];
    const auto old = std::lower_bound(before_.begin() + static_cast<std::ptrdiff_t>(old_begin),
                                      before_.begin() + static_cast<std::ptrdiff_t>(s.old_end), first,
                                      [](const Before& b, Place particle) { return b.particle < particle; }) -
                     before_.begin();
    own.found.end = settle(s, entries, static_cast<std::size_t>(old), own, at, found);
}

/// Makes contacts of the pieces found from `begin` on, in their place; returns where these end.
std::int32_t WallTouches::settle(const Search& s, Range entries, std::size_t old_begin, Scratch& own,
                                 std::int32_t begin, std::int32_t found) const {
    Columns& c = *s.columns;
    std::int32_t at = begin;
    Spread before{old_begin, old_begin};
    for (std::int32_t k = begin; k < begin + found;) {
        const auto here = static_cast<std::size_t>(k);
        const std::int32_t entry = s.entry[k];
        const Place particle = s.pieces->particle[static_cast<std::size_t>(entries.begin + entry)];
        std::int32_t end = k + 1;
        while (end < begin + found && s.entry[end] == entry) ++end;
        const std::int32_t mine = at;
        if (end == k + 1 && c.touch_overlap[here] > undecided) {
            if (at != k) move_touch(c, here, static_cast<std::size_t>(at));
            ++at;
        } else {
            own.of_one.assign(s.piece + k, s.piece + end);
            at = ask_shape(s, own, particle, at);
        }
        k = end;
        before.begin = before.end;
        while (before.begin < s.old_end && before_[before.begin].particle < particle) ++before.begin;
        before.end = before.begin;
        while (before.end < s.old_end && before_[before.end].particle == particle) ++before.end;
        inherit(s, own, before, mine, at);
    }
    return at;
}

/// Moves the contacts of all parts together, from `at` on; returns their end.
std::int32_t WallTouches::close_gaps(Columns& c, std::int32_t at, const Parts& parts) {
    if (parts.count() == 1) return scratch_.front().found.end;
    std::vector<std::int32_t> to{at};
    for (int part = 0; part < parts.count(); ++part) {
        const WallSegment& found = scratch_[static_cast<std::size_t>(part)].found;
        to.push_back(to.back() + found.end - found.begin);
    }
    const auto close = [&](auto& column) {
        for (std::size_t part = 1; part + 1 < to.size(); ++part) {
            const WallSegment& found = scratch_[part].found;
            std::copy(column.data() + found.begin, column.data() + found.end, column.data() + to[part]);
        }
    };
    parts.run([&](int part) {  // column by column
        int number = 0;
        const auto mine = [&] { return number++ % parts.count() == part; };
        if (mine()) close(c.touch_particle);
        if (mine()) close(c.touch_overlap);
        for (auto* vector : {c.touch_normal, c.touch_velocity, c.touch_lever})
            for (int a = 0; a < 3; ++a)
                if (mine()) close(vector[a]);
        for (int a = 0; a < c.histories; ++a)
            if (mine()) close(c.touch_memory_next[a]);
    });
    return to.back();
}

/// Writes where the shape says that the pieces own.of_one are touched, from `at` on; returns where that ends.
std::int32_t WallTouches::ask_shape(const Search& s, Scratch& own, Place particle, std::int32_t at) {
    const MovingWall& wall = *s.wall;
    const Scale& scale = *s.scale;
    Columns& c = *s.columns;
    const auto i = static_cast<std::int32_t>(record_index(particle));
    const double radius = radius_at_walls(*s.field, i, scale);
    const Vec3 x = wall.image().of(position_at_walls(*s.field, i, scale));
    const double reach = radius + double{s.field->constants.beyond_wall} * scale.length;
    const Twist& twist = wall.twist();
    own.places.clear();
    if_pieced(wall, [&](const auto& shape) { shape.touching(wall.pose().to_body(x), reach, own.of_one, own.places); });
    for (const Closest& place : own.places) {
        const auto k = static_cast<std::size_t>(at++);
        const Vec3 normal = wall.pose().turned ? wall.pose().turn(place.normal) : place.normal;
        const Vec3 on_wall = x - place.distance * normal, velocity = twist.at(on_wall, normal), lever = on_wall - twist.pivot;
        c.touch_particle[k] = particle;
        c.touch_overlap[k] = static_cast<float>((radius - place.distance) / scale.length);
        for (std::size_t a = 0; a < 3; ++a) {
            c.touch_normal[a][k] = static_cast<float>(normal[a]);
            c.touch_velocity[a][k] = static_cast<float>(velocity[a] / scale.speed());
            c.touch_lever[a][k] = static_cast<float>(lever[a] / scale.length);
        }
    }
    return at;
}

/// The memories of one particle's contacts.
void WallTouches::inherit(const Search& s, Scratch& own, Spread before, std::int32_t begin, std::int32_t end) const {
    Columns& c = *s.columns;
    const auto count = static_cast<std::size_t>(end - begin);
    const auto normal_now = [&](std::size_t k) {
        return Vec3{double{c.touch_normal[0][k]}, double{c.touch_normal[1][k]}, double{c.touch_normal[2][k]}};
    };
    const auto normal_before = [&](std::size_t k) {
        const float* n = before_[k].normal;
        return Vec3{double{n[0]}, double{n[1]}, double{n[2]}};
    };
    const auto give = [&](std::size_t to, std::optional<std::size_t> from) {
        for (int a = 0; a < c.histories; ++a) c.touch_memory_next[a][to] = from ? c.touch_memory[a][*from] : 0;
    };
    const auto first = static_cast<std::size_t>(begin);
    if (before.begin == before.end) {
        for (std::size_t k = 0; k < count; ++k) give(first + k, std::nullopt);
        return;
    }
    if (count == 1 && before.end == before.begin + 1) {  // the same rule, for the many
        const Vec3 turn = normal_now(first) - normal_before(before.begin);
        const double chord = 2 * std::sin(largest_turn / 2);
        give(first, dot(turn, turn) < chord * chord ? std::optional(before.begin) : std::nullopt);
        return;
    }
    own.before.clear(), own.now.clear();
    for (std::size_t k = before.begin; k < before.end; ++k) own.before.push_back({0, {0, normal_before(k)}});
    for (std::size_t k = 0; k < count; ++k) own.now.push_back({0, {0, normal_now(first + k)}});
    s.wall->inherit(own.before, own.now, own.from);
    for (std::size_t k = 0; k < count; ++k)
        give(first + k,
             own.from[k] < 0 ? std::nullopt : std::optional(before.begin + static_cast<std::size_t>(own.from[k])));
}

}  // namespace grainsweep::dem::fast
