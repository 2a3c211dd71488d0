#include "solver/dem/fast/wall_touches.hpp"

#include <algorithm>
#include <cmath>

#include "solver/dem/fast/wall_lists.hpp"
#include "solver/geometry/contact_memory.hpp"

namespace grainsweep::dem::fast {

using namespace geometry;

namespace {

/// Gap below which a piece counts, in largest diameters: a wider one asks for more pieces, a narrower one to choose
/// them anew more often. Of 0.008, 0.015, 0.03 and 0.06 this is the fastest in a turning drum of triangles.
constexpr double piece_skin = 0.015;

std::size_t index_of(Place place) {
    return place / places_per_index;
}

/// A particle's centre in the frame of the wall's body, m.
Vec3 in_body(const MovingWall& wall, const Record& record, const Scale& scale) {
    return wall.pose().to_body(wall.image().of(position_of(record, scale)));
}

double radius_of(const Record& record, const Scale& scale) {
    return static_cast<double>(record.radius) * scale.length;
}

/// Calls visit(shape) if the wall's shape is made of pieces.
template <class Visit>
void if_pieced(const MovingWall& wall, Visit&& visit) {
    std::visit(
        [&]<class S>(const S& shape) {
            if constexpr (Pieced<S>) visit(shape);
        },
        wall.found());
}

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

void WallTouches::begin(Field& f, Columns& c, const Walls& walls, const Scale& scale) {
    segment_.assign(walls.count(), WallSegment{0, 0});
    write_pieces(walls, scale);
    publish(f, c);
}

void WallTouches::write_pieces(const Walls& walls, const Scale& scale) {
    pieced_.clear();
    for (std::size_t w = 0; w < walls.count(); ++w)
        if_pieced(walls[w], [&]<class S>(const S& shape) {
            using Numbers = typename S::PieceNumbers;
            PieceWall& p = pieced_.emplace_back();
            p.wall = w;
            p.stride = sizeof(Numbers) / sizeof(double);
            p.numbers.resize(shape.pieces() * static_cast<std::size_t>(p.stride));
            double extent = 0;
            for (std::size_t a = 0; a < 3; ++a)
                extent = std::max({extent, std::abs(shape.extent(a).low), std::abs(shape.extent(a).high)});
            p.margin = 1e-9 * (1 + extent / scale.length);
            for (std::size_t k = 0; k < shape.pieces(); ++k) {
                const Numbers numbers = shape.piece(k, scale.length);
                std::memcpy(p.numbers.data() + k * static_cast<std::size_t>(p.stride), &numbers, sizeof numbers);
            }
        });
}

/// Gives the kernels the segments and columns.
void WallTouches::publish(Field& f, Columns& c) const {
    c.touched.hold(segment_.size());
    std::ranges::copy(segment_, c.touched.data());
    c.hold_touches(segment_.empty() ? 0 : static_cast<std::size_t>(segment_.back().end));
    c.bind(f);
}

void WallTouches::list(const Field& f, const Walls& walls, const Scale& scale, double reach) {
    for (PieceWall& p : pieced_) {
        p.particle.clear(), p.first.clear(), p.candidate.clear();
        const MovingWall& wall = walls[p.wall];
        const double far = (reach + double{f.constants.beyond_wall}) * (1 + 1e-5) * scale.length;
        if_pieced(wall, [&](const auto& shape) {
            for (std::int32_t i = 0; i < f.count; ++i) {
                const Record& r = f.records[i];
                if (!(r.inverse_mass > 0)) continue;
                shape.near(in_body(wall, r, scale), radius_of(r, scale) + far, of_one_);
                if (of_one_.empty()) continue;
                p.particle.push_back(static_cast<Place>(i * places_per_index));
                p.first.push_back(static_cast<std::int32_t>(p.candidate.size()));
                p.candidate.insert(p.candidate.end(), of_one_.begin(), of_one_.end());
            }
        });
        p.active.assign(p.particle.size(), 0);
        p.wake.assign(p.particle.size(), 0);
        p.first.push_back(static_cast<std::int32_t>(p.candidate.size()));
    }
}

/// Chooses the candidates that count of those particles that may have come near others; returns how many count in all.
std::int64_t WallTouches::refresh(PieceWall& p, const Field& f, const MovingWall& wall, const Scale& scale,
                                  double drift) {
    std::int64_t active = 0;
    if_pieced(wall, [&]<class S>(const S&) {
        for (std::size_t n = 0; n < p.particle.size(); ++n) {
            if (p.wake[n] <= drift) {
                const Record& r = f.records[index_of(p.particle[n])];
                const Vec3 x = (1 / scale.length) * in_body(wall, r, scale);
                double rest = std::numeric_limits<double>::infinity();
                std::int32_t chosen = p.first[n];
                for (std::int32_t k = p.first[n]; k < p.first[n + 1]; ++k) {
                    std::uint32_t& candidate = p.candidate[static_cast<std::size_t>(k)];
                    const double* numbers =
                        p.numbers.data() + std::size_t{candidate} * static_cast<std::size_t>(p.stride);
                    const NearPiece<double> near = S::near_piece(numbers, x[0], x[1], x[2]);
                    const double beyond = std::min(near.inside, 0.0);
                    const double gap = std::sqrt(near.height * near.height + beyond * beyond) - double{r.radius} -
                                       double{f.constants.beyond_wall};
                    if (gap >= piece_skin)
                        rest = std::min(rest, gap);
                    else
                        std::swap(candidate, p.candidate[static_cast<std::size_t>(chosen++)]);
                }
                p.active[n] = chosen - p.first[n];
                p.wake[n] = drift + rest * (1 - 1e-5);
            }
            active += p.active[n];
        }
    });
    return active;
}

void WallTouches::find(Field& f, Columns& c, const Walls& walls, const Kernels& kernels, const Scale& scale,
                       double drift) {
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
            const std::int64_t most = at + refresh(p, f, walls[w], scale, drift);
            c.hold_touches(static_cast<std::size_t>(most));
            c.bind(f);
            entry_.resize(static_cast<std::size_t>(most + spare));
            piece_.resize(entry_.size());
            const PieceList list{
                p.numbers.data(),  p.stride,       p.margin,        static_cast<std::int32_t>(p.particle.size()),
                p.particle.data(), p.first.data(), p.active.data(), p.candidate.data(),
                entry_.data(),     piece_.data()};
            const std::int32_t found = kernels.pieces(f, static_cast<std::int32_t>(w), list, at);
            at = settle(p, walls[w], f, c, scale, old, at, found);
        }
        segment_[w].end = at;
    }
    for (int a = 0; a < c.histories; ++a) c.touch_memory[a].swap(c.touch_memory_next[a]);
    publish(f, c);
}

/// Makes contacts of the pieces found from `begin` on, in their place; returns where these end.
std::int32_t WallTouches::settle(const PieceWall& p, const MovingWall& wall, const Field& f, Columns& c,
                                 const Scale& scale, WallSegment old, std::int32_t begin, std::int32_t found) {
    std::int32_t at = begin;
    Spread before{static_cast<std::size_t>(old.begin), static_cast<std::size_t>(old.begin)};
    const auto old_end = static_cast<std::size_t>(old.end);
    for (std::int32_t k = begin; k < begin + found;) {
        const auto first = static_cast<std::size_t>(k);
        const std::int32_t entry = entry_[first];
        const Place particle = p.particle[static_cast<std::size_t>(entry)];
        std::int32_t end = k + 1;
        while (end < begin + found && entry_[static_cast<std::size_t>(end)] == entry) ++end;
        const std::int32_t mine = at;
        if (end == k + 1 && c.touch_overlap[first] > undecided) {
            if (at != k) move_touch(c, first, static_cast<std::size_t>(at));
            ++at;
        } else {
            of_one_.assign(piece_.begin() + k, piece_.begin() + end);
            at = ask_shape(wall, f, c, scale, particle, at);
        }
        k = end;
        before.begin = before.end;
        while (before.begin < old_end && before_[before.begin].particle < particle) ++before.begin;
        before.end = before.begin;
        while (before.end < old_end && before_[before.end].particle == particle) ++before.end;
        inherit(wall, c, before, mine, at);
    }
    return at;
}

/// Writes where the shape says that its pieces of_one_ are touched, from `at` on; returns where that ends.
std::int32_t WallTouches::ask_shape(const MovingWall& wall, const Field& f, Columns& c, const Scale& scale,
                                    Place particle, std::int32_t at) {
    const Record& r = f.records[index_of(particle)];
    const double radius = radius_of(r, scale);
    const Vec3 x = wall.image().of(position_of(r, scale));
    const double reach = radius + double{f.constants.beyond_wall} * scale.length;
    const Twist& twist = wall.twist();
    places_.clear();
    if_pieced(wall, [&](const auto& shape) { shape.touching(wall.pose().to_body(x), reach, of_one_, places_); });
    for (const Closest& place : places_) {
        const auto k = static_cast<std::size_t>(at++);
        const Vec3 normal = wall.pose().turned ? wall.pose().turn(place.normal) : place.normal;
        const Vec3 on_wall = x - place.distance * normal, velocity = twist.at(on_wall), lever = on_wall - twist.pivot;
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
void WallTouches::inherit(const MovingWall& wall, Columns& c, Spread before, std::int32_t begin, std::int32_t end) {
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
    touches_before_.clear(), touches_now_.clear();
    for (std::size_t k = before.begin; k < before.end; ++k) touches_before_.push_back({0, {0, normal_before(k)}});
    for (std::size_t k = 0; k < count; ++k) touches_now_.push_back({0, {0, normal_now(first + k)}});
    wall.inherit(touches_before_, touches_now_, from_);
    for (std::size_t k = 0; k < count; ++k)
        give(first + k, from_[k] < 0 ? std::nullopt : std::optional(before.begin + static_cast<std::size_t>(from_[k])));
}

std::optional<WallTouches::Passage> WallTouches::passage(const Field& f, const Walls& walls, const Scale& scale,
                                                         double time, double moved, double smallest_radius) const {
    const auto deep = static_cast<float>(smallest_radius - moved * (1 + 1e-5));
    for (const PieceWall& p : pieced_) {
        const MovingWall& wall = walls[p.wall];
        if (!wall.thin()) continue;
        const Pose before = wall.pose_at(time - scale.time);
        for (std::int32_t k = segment_[p.wall].begin; k < segment_[p.wall].end; ++k) {
            if (f.touch_overlap[k] < deep) continue;
            const std::size_t i = index_of(f.touch_particle[k]);
            const Vec3 x = position_of(f.records[i], scale);
            Vec3 way{};
            for (std::size_t a = 0; a < 3; ++a) way[a] = double{f.records[i].velocity[a]} * scale.length;
            if (wall.passed(before, x - way, x))
                return Passage{static_cast<std::int32_t>(i), static_cast<std::int32_t>(p.wall)};
        }
    }
    return std::nullopt;
}

void WallTouches::reorder(Field& f, Columns& c) {
    if (pieced_.empty()) return;
    std::vector<std::size_t> order;
    std::vector<Place> place(static_cast<std::size_t>(segment_.back().end));
    std::vector<float> normal[3];
    std::size_t at = 0;
    std::vector<Place> ordered;
    for (WallSegment& s : segment_) {
        order.clear();
        for (auto k = static_cast<std::size_t>(s.begin); k < static_cast<std::size_t>(s.end); ++k) {
            const std::int32_t to = c.place[index_of(c.touch_particle[k])];
            place[k] = static_cast<Place>(to * places_per_index);
            if (to >= 0) order.push_back(k);
        }
        std::ranges::stable_sort(order, {}, [&](std::size_t k) { return place[k]; });
        s.begin = static_cast<std::int32_t>(at);
        for (const std::size_t k : order) {
            for (int a = 0; a < c.histories; ++a) c.touch_memory_next[a][at] = c.touch_memory[a][k];
            for (std::size_t a = 0; a < 3; ++a) normal[a].push_back(c.touch_normal[a][k]);
            ordered.push_back(place[k]);
            ++at;
        }
        s.end = static_cast<std::int32_t>(at);
    }
    std::ranges::copy(ordered, c.touch_particle.data());
    for (std::size_t a = 0; a < 3; ++a) std::ranges::copy(normal[a], c.touch_normal[a].data());
    for (int a = 0; a < c.histories; ++a) c.touch_memory[a].swap(c.touch_memory_next[a]);
    publish(f, c);
}

bool WallTouches::fits(const Columns& c, std::size_t walls, std::int32_t particles) const {
    if (segment_.size() != walls) return false;
    std::int32_t end = 0;
    for (const WallSegment& s : segment_) {
        if (s.begin != end || s.end < s.begin) return false;
        end = s.end;
    }
    for (std::size_t k = 0; k < static_cast<std::size_t>(end); ++k) {
        const Place place = c.touch_particle[k];
        if (place % places_per_index != 0 || index_of(place) >= static_cast<std::size_t>(particles)) return false;
    }
    return true;
}

void WallTouches::restored(Field& f, Columns& c, const Walls& walls, const Scale& scale, double reach) {
    write_pieces(walls, scale);
    list(f, walls, scale, reach > 0 ? reach : 0);
    publish(f, c);
}

}  // namespace grainsweep::dem::fast
