#include "solver/dem/fast/wall_touches.hpp"

#include <algorithm>
#include <cmath>

#include "solver/dem/fast/pieced_walls.hpp"

namespace grainsweep::dem::fast {

using namespace geometry;

namespace {

/// Gap below which a piece counts, in largest diameters: a wider one asks for more pieces, a narrower one to choose
/// them anew more often. Of 0.008, 0.015, 0.03 and 0.06 this is the fastest in a turning drum of triangles.
constexpr double piece_skin = 0.015;

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

void WallTouches::list(const Field& f, const Walls& walls, const Scale& scale, double reach, const Parts& parts) {
    struct Found {
        std::vector<Place> particle;
        std::vector<std::int32_t> first;
        std::vector<std::uint32_t> candidate, of_one, of_image;
    };
    std::vector<Found> found(pieced_.empty() ? 0 : static_cast<std::size_t>(parts.count()));
    for (PieceWall& p : pieced_) {
        const MovingWall& wall = walls[p.wall];
        const double far = (reach + double{f.constants.beyond_wall}) * (1 + 1e-5) * scale.length;
        p.seam = far;
        parts.run([&](int part) {
            Found& mine = found[static_cast<std::size_t>(part)];
            mine.particle.clear(), mine.first.clear(), mine.candidate.clear();
            if (!wall.present()) return;
            const Range range = parts.share(part, f.count);
            if_pieced(wall, [&](const auto& shape) {
                for (std::int32_t i = range.begin; i < range.end; ++i) {
                    const Record& r = f.records[i];
                    if (!(r.inverse_mass > 0 && wall.wall().touches(f.kind[i]))) continue;
                    mine.of_one.clear();
                    each_image(wall, r, scale, far, [&](const Vec3& x) {
                        shape.near(x, radius_of(r, scale) + far, mine.of_image);
                        if (mine.of_one.empty()) return mine.of_one.swap(mine.of_image);
                        for (const std::uint32_t piece : mine.of_image)
                            if (std::ranges::find(mine.of_one, piece) == mine.of_one.end())
                                mine.of_one.push_back(piece);
                    });
                    if (mine.of_one.empty()) continue;
                    mine.particle.push_back(static_cast<Place>(i * places_per_index));
                    mine.first.push_back(static_cast<std::int32_t>(mine.candidate.size()));
                    mine.candidate.insert(mine.candidate.end(), mine.of_one.begin(), mine.of_one.end());
                }
            });
        });
        p.particle.clear(), p.first.clear(), p.candidate.clear();
        for (const Found& one : found) {
            const auto before = static_cast<std::int32_t>(p.candidate.size());
            p.particle.insert(p.particle.end(), one.particle.begin(), one.particle.end());
            for (const std::int32_t first : one.first) p.first.push_back(before + first);
            p.candidate.insert(p.candidate.end(), one.candidate.begin(), one.candidate.end());
        }
        p.active.assign(p.particle.size(), 0);
        p.wake.assign(p.particle.size(), 0);
        p.first.push_back(static_cast<std::int32_t>(p.candidate.size()));
    }
}

/// Chooses the candidates that count of those particles that may have come near others.
void WallTouches::refresh(PieceWall& p, Range entries, const Field& f, const MovingWall& wall, const Scale& scale,
                          double drift) {
    std::vector<Vec3> images;
    if_pieced(wall, [&]<class S>(const S&) {
        for (auto n = static_cast<std::size_t>(entries.begin); n < static_cast<std::size_t>(entries.end); ++n) {
            if (!(p.wake[n] <= drift)) continue;
            const Record& r = f.records[record_index(p.particle[n])];
            images.clear();
            each_image(wall, r, scale, p.seam, [&](const Vec3& x) { images.push_back((1 / scale.length) * x); });
            double rest = std::numeric_limits<double>::infinity();
            std::int32_t chosen = p.first[n];
            for (std::int32_t k = p.first[n]; k < p.first[n + 1]; ++k) {
                std::uint32_t& candidate = p.candidate[static_cast<std::size_t>(k)];
                const double* numbers = p.numbers.data() + std::size_t{candidate} * static_cast<std::size_t>(p.stride);
                double gap = std::numeric_limits<double>::infinity();
                for (const Vec3& x : images) {
                    const NearPiece<double> near = S::near_piece(numbers, x[0], x[1], x[2]);
                    const double beyond = std::min(near.inside, 0.0);
                    gap = std::min(gap, std::sqrt(near.height * near.height + beyond * beyond) - double{r.radius} -
                                            double{f.constants.beyond_wall});
                }
                if (gap >= piece_skin)
                    rest = std::min(rest, gap);
                else
                    std::swap(candidate, p.candidate[static_cast<std::size_t>(chosen++)]);
            }
            p.active[n] = chosen - p.first[n];
            p.wake[n] = drift + rest * (1 - 1e-5);
        }
    });
}

std::optional<WallTouches::Passage> WallTouches::passage(const Field& f, const Walls& walls, const Scale& scale,
                                                         double time, double moved, double smallest_radius) const {
    const auto deep = static_cast<float>(smallest_radius - moved * (1 + 1e-5));
    for (const PieceWall& p : pieced_) {
        const MovingWall& wall = walls[p.wall];
        if (!wall.thin()) continue;
        const Pose before = wall.pose_before(time - scale.time);
        for (std::int32_t k = segment_[p.wall].begin; k < segment_[p.wall].end; ++k) {
            if (f.touch_overlap[k] < deep) continue;
            const std::size_t i = record_index(f.touch_particle[k]);
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
            const std::int32_t to = c.place[record_index(c.touch_particle[k])];
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
        if (place % places_per_index != 0 || record_index(place) >= static_cast<std::size_t>(particles)) return false;
    }
    return true;
}

void WallTouches::restored(Field& f, Columns& c, const Walls& walls, const Scale& scale, double reach) {
    write_pieces(walls, scale);
    list(f, walls, scale, reach > 0 ? reach : 0, {});
    publish(f, c);
}

}  // namespace grainsweep::dem::fast
