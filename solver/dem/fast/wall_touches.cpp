#include "solver/dem/fast/wall_touches.hpp"

#include <algorithm>
#include <numeric>

#include "solver/dem/fast/wall_lists.hpp"

namespace grainsweep::dem::fast {

using namespace geometry;

void WallTouches::begin(Field& f, Columns& c, const Walls& walls) {
    segment_.assign(walls.count(), WallSegment{0, 0});
    particle_.clear();
    normal_.clear();
    publish(f, c);
}

/// Gives the kernels the segments and columns.
void WallTouches::publish(Field& f, Columns& c) const {
    c.touched.hold(segment_.size());
    std::ranges::copy(segment_, c.touched.data());
    c.hold_touches(particle_.size());
    c.bind(f);
}

/// The listed particles of a wall, and where they are.
void WallTouches::gather_near(const Field& f, std::size_t wall, const Scale& scale) {
    near_.clear();
    position_.resize(static_cast<std::size_t>(f.count));
    radius_.resize(static_cast<std::size_t>(f.count));
    for (std::int32_t k = f.segments[wall].begin; k < f.segments[wall].end; ++k) {
        const std::uint32_t i = f.wall_particle[k] / places_per_index;
        if (i >= static_cast<std::uint32_t>(f.count)) continue;  // fills the segment up
        near_.push_back(i);
        position_[i] = position_of(f.records[i], scale);
        radius_[i] = static_cast<double>(f.records[i].radius) * scale.length;
    }
}

void WallTouches::find(Field& f, Columns& c, const Walls& walls, const Scale& scale) {
    if (walls.all_single()) return;
    particle_.swap(particle_before_);
    normal_.swap(normal_before_);
    particle_.clear();
    normal_.clear();
    for (std::size_t w = 0; w < walls.count(); ++w) {
        const WallSegment old = segment_[w];
        segment_[w].begin = segment_[w].end = static_cast<std::int32_t>(particle_.size());
        if (walls.is_single(w)) continue;
        gather_near(f, w, scale);
        const double beyond = static_cast<double>(f.constants.beyond_wall) * scale.length;
        walls[w].find(near_, position_, {0, radius_}, beyond, now_);
        c.hold_touches(particle_.size() + now_.size());
        inherit(walls[w], old, c);
        write(c, walls[w], scale);
        segment_[w].end = static_cast<std::int32_t>(particle_.size());
    }
    for (int a = 0; a < c.histories; ++a) c.touch_memory[a].swap(c.touch_memory_next[a]);
    publish(f, c);
}

/// The memories of what is touched now, particle by particle.
void WallTouches::inherit(const MovingWall& wall, const WallSegment& old, Columns& c) {
    auto b = static_cast<std::size_t>(old.begin);
    const auto end = static_cast<std::size_t>(old.end);
    for (std::size_t n = 0; n < now_.size();) {
        const std::uint32_t entry = now_[n].entry;
        const auto particle = static_cast<std::int32_t>(near_[entry]);
        while (b < end && particle_before_[b] < particle) ++b;
        one_before_.clear();
        for (std::size_t k = b; k < end && particle_before_[k] == particle; ++k)
            one_before_.push_back({entry, {0, normal_before_[k]}});
        std::size_t n_end = n;
        while (n_end < now_.size() && now_[n_end].entry == entry) ++n_end;
        wall.inherit(one_before_, {now_.data() + n, n_end - n}, from_);
        for (std::size_t k = 0; k < from_.size(); ++k)
            for (int a = 0; a < c.histories; ++a)
                c.touch_memory_next[a][particle_.size() + n + k] =
                    from_[k] < 0 ? 0 : c.touch_memory[a][b + static_cast<std::size_t>(from_[k])];
        n = n_end;
    }
}

/// Appends what is touched now, in the engine's units.
void WallTouches::write(Columns& c, const MovingWall& wall, const Scale& scale) {
    const Twist& twist = wall.twist();
    for (const auto& [entry, place] : now_) {
        const std::size_t at = particle_.size(), i = near_[entry];
        const Vec3 on_wall = wall.image().of(position_[i]) - place.distance * place.normal;
        const Vec3 velocity = twist.at(on_wall), lever = on_wall - twist.pivot;
        particle_.push_back(static_cast<std::int32_t>(i));
        normal_.push_back(place.normal);
        c.touch_particle[at] = static_cast<Place>(i * places_per_index);
        c.touch_overlap[at] = static_cast<float>((radius_[i] - place.distance) / scale.length);
        for (std::size_t a = 0; a < 3; ++a) {
            c.touch_normal[a][at] = static_cast<float>(place.normal[a]);
            c.touch_velocity[a][at] = static_cast<float>(velocity[a] / scale.speed());
            c.touch_lever[a][at] = static_cast<float>(lever[a] / scale.length);
        }
    }
}

void WallTouches::reorder(Field& f, Columns& c) {
    if (particle_.empty()) return;
    particle_.swap(particle_before_);
    normal_.swap(normal_before_);
    particle_.clear();
    normal_.clear();
    std::vector<std::size_t> order;
    for (WallSegment& s : segment_) {
        order.clear();
        for (auto k = static_cast<std::size_t>(s.begin); k < static_cast<std::size_t>(s.end); ++k) {
            std::int32_t& i = particle_before_[k];
            i = c.place[static_cast<std::size_t>(i)];
            if (i >= 0) order.push_back(k);
        }
        std::ranges::stable_sort(order, {}, [&](std::size_t k) { return particle_before_[k]; });
        s.begin = static_cast<std::int32_t>(particle_.size());
        for (const std::size_t k : order) {
            for (int a = 0; a < c.histories; ++a) c.touch_memory_next[a][particle_.size()] = c.touch_memory[a][k];
            particle_.push_back(particle_before_[k]);
            normal_.push_back(normal_before_[k]);
        }
        s.end = static_cast<std::int32_t>(particle_.size());
    }
    for (int a = 0; a < c.histories; ++a) c.touch_memory[a].swap(c.touch_memory_next[a]);
    publish(f, c);
}

std::optional<WallTouches::Passage> WallTouches::passage(const Field& f, const Walls& walls, const Scale& scale,
                                                         double time) {
    if (walls.all_single()) return std::nullopt;
    for (std::size_t w = 0; w < walls.count(); ++w) {
        const MovingWall& wall = walls[w];
        if (!wall.thin()) continue;
        gather_near(f, w, scale);
        const double way_of_wall = scale.time * wall.fastest_surface();
        const Pose before = wall.pose_at(time - scale.time);
        auto k = static_cast<std::size_t>(segment_[w].begin);
        for (const std::uint32_t i : near_) {
            double distance = radius_[i];
            for (; k < static_cast<std::size_t>(segment_[w].end) && particle_[k] == static_cast<std::int32_t>(i); ++k)
                distance = std::min(distance, radius_[i] - static_cast<double>(f.touch_overlap[k]) * scale.length);
            Vec3 moved{};
            for (std::size_t a = 0; a < 3; ++a) moved[a] = static_cast<double>(f.records[i].velocity[a]) * scale.length;
            if (distance > 1.0001 * norm(moved) + way_of_wall) continue;
            if (wall.passed(before, position_[i] - moved, position_[i]))
                return Passage{static_cast<std::int32_t>(i), static_cast<std::int32_t>(w)};
        }
    }
    return std::nullopt;
}

bool WallTouches::fits(std::size_t walls, std::int32_t particles) const {
    if (segment_.size() != walls || particle_.size() != normal_.size()) return false;
    std::int32_t end = 0;
    for (const WallSegment& s : segment_) {
        if (s.begin != end || s.end < s.begin) return false;
        end = s.end;
    }
    return static_cast<std::size_t>(end) == particle_.size() &&
           std::ranges::all_of(particle_, [&](std::int32_t i) { return i >= 0 && i < particles; });
}

void WallTouches::restored(Field& f, Columns& c) const {
    publish(f, c);
}

}  // namespace grainsweep::dem::fast
