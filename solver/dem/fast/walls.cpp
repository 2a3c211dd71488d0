#include "solver/dem/fast/walls.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "solver/dem/limits.hpp"
#include "solver/dem/walls/wall_bytes.hpp"

namespace grainsweep::dem::fast {

using namespace geometry;

namespace {

/// Gives a wall the numbers of its shape and their reference.
template <class S>
void write_shape(const S& shape, const Pose& pose, const Scale& scale, PlacedWall& w) {
    static_assert(Vectorised<S> || Pieced<S>);
    Vec3 origin{};
    const auto in_body_frame = [&] {
        origin = (1 / scale.length) * (pose.shift - scale.centre) + (pose.turned ? pose.turn(origin) : origin);
    };
    if constexpr (Vectorised<S>) {
        using Numbers = typename S::Numbers;
        static_assert(sizeof(Numbers) <= numbers_at_most);
        Numbers numbers{};
        bool stands = false;
        if constexpr (Movable<S>) {
            stands = !pose.turned;
            if (stands) numbers = shape.moved(pose.shift).numbers(scale.centre, scale.length, origin);
        }
        if (!stands) {
            numbers = shape.numbers({}, scale.length, origin);
            in_body_frame();
        }
        std::memcpy(w.numbers, &numbers, sizeof numbers);
    } else {
        in_body_frame();
    }
    std::ranges::copy(origin, w.origin);
}

void write_pose(const MovingWall& wall, const Scale& scale, PlacedWall& w) {
    const Pose& pose = wall.pose();
    w.turned = pose.turned ? 1 : 0;
    for (std::size_t a = 0; a < 3; ++a) std::ranges::copy(pose.rows[a], w.rows[a]);
    std::visit([&](const auto& shape) { write_shape(shape, pose, scale, w); }, wall.wall().shape);
    const NearestImage& image = wall.image();
    w.imaged = 0;
    for (std::size_t a = 0; a < 3; ++a) {
        if (!(image.period[a] > 0)) continue;
        w.imaged = 1;
        w.middle[a] = (image.middle[a] - scale.centre[a]) / scale.length - w.origin[a];
        w.period[a] = image.period[a] / scale.length;
        w.inverse_period[a] = 1 / w.period[a];
    }
}

void write_twist(const Twist& twist, const Scale& scale, PlacedWall& w) {
    w.turns = twist.turns ? 1 : 0;
    w.conveys = twist.conveys ? 1 : 0;
    for (std::size_t a = 0; a < 3; ++a) {
        w.velocity[a] = twist.velocity[a] / scale.speed();
        w.surface[a] = twist.surface[a] / scale.speed();
        w.spin[a] = twist.spin[a] * scale.time;
        w.pivot[a] = (twist.pivot[a] - scale.centre[a]) / scale.length - w.origin[a];
    }
}

std::vector<Wall> read_walls(Reader& archive) {
    std::size_t count = 0;
    archive.value(count);
    std::vector<Wall> walls;
    for (std::size_t w = 0; w < count; ++w) walls.push_back(read_wall([&](auto& value) { archive.value(value); }));
    return walls;
}

}  // namespace

Walls::Walls(const std::vector<Wall>& walls, const Domain& domain, const Scale& scale, std::int32_t combination,
             const ContactTable& table, std::span<const Material> materials)
    : combination_(combination),
      scale_(scale),
      placed_(walls.size()),
      sums_(walls.size()),
      pivot_(walls.size()),
      work_(walls.size()) {
    std::vector<Material> together(materials.begin(), materials.end());
    together.emplace_back();
    const auto beyond = [&](const Material& m) { return make_contact(combination, m)->beyond(0.5 * scale.length); };
    double furthest = 0;
    for (const Material& m : materials) furthest = std::max(furthest, beyond(m));
    for (std::size_t w = 0; w < walls.size(); ++w) {
        laws_.emplace_back();
        constants_.emplace_back(table.kinds() * constants_at_most);
        for (std::size_t kind = 0; kind < table.kinds(); ++kind) {
            const Material& surface = together.back() = table.at_wall(walls[w], kind);
            if (!fits(combination, together))
                throw std::invalid_argument(
                    "the surface of a wall has friction or cohesion that nothing at the start had");
            if (beyond(surface) > furthest)
                throw std::invalid_argument(
                    "the surface of a wall attracts from further than anything at the start did");
            laws_.back().push_back(make_contact(combination, surface));
            write_law_constants(combination, surface, scale, constants_.back().data() + kind * constants_at_most);
        }
        std::copy_n(constants_.back().data(), constants_at_most, placed_[w].laws);
        placed_[w].laws_of_kinds = constants_.back().data();
        moving_.emplace_back(walls[w], domain, 0.5 * scale.length);
        any_free_ = any_free_ || moving_.back().free();
        single_.push_back(std::visit([]<class S>(const S&) { return Vectorised<S>; }, walls[w].shape));
        placed_[w].shape = static_cast<std::int32_t>(walls[w].shape.index());
        place(w, 0);
    }
}

void Walls::use_scale(const Scale& scale, const ContactTable& table) {
    const double of_time = scale.time / scale_.time, of_force = of_time * of_time;
    scale_ = scale;
    for (std::size_t w = 0; w < count(); ++w) {
        for (std::size_t kind = 0; kind < table.kinds(); ++kind)
            write_law_constants(combination_, table.at_wall(moving_[w].wall(), kind), scale,
                                constants_[w].data() + kind * constants_at_most);
        std::copy_n(constants_[w].data(), constants_at_most, placed_[w].laws);
        write_twist(moving_[w].twist(), scale_, placed_[w]);
        for (int a = 0; a < 3; ++a) sums_[w].force[a] *= of_force, sums_[w].torque[a] *= of_force;
        sums_[w].power *= of_force;
        work_[w] *= of_force;
    }
}

std::vector<MovingWall> Walls::moving_as(const std::vector<Wall>& walls, const Domain& domain) const {
    if (walls.size() != count()) throw std::invalid_argument("walls that change keep their number");
    std::vector<MovingWall> changed;
    for (std::size_t w = 0; w < count(); ++w) changed.push_back(moving_[w].moving_as(walls[w], domain));
    return changed;
}

void Walls::take(std::vector<MovingWall> changed, double time) {
    moving_ = std::move(changed);
    any_free_ = std::ranges::any_of(moving_, &MovingWall::free);
    for (std::size_t w = 0; w < count(); ++w) {
        place(w, time);
        if (!moving_[w].present()) sums_[w] = {};
    }
}

void Walls::place(std::size_t w, double time) {
    moving_[w].place(time);
    write_pose(moving_[w], scale_, placed_[w]);
    write_twist(moving_[w].twist(), scale_, placed_[w]);
    pivot_[w] = moving_[w].twist().pivot;
}

void Walls::place(double time) {
    for (std::size_t w = 0; w < count(); ++w)
        if (moves(w)) place(w, time);
}

void Walls::kick(double time, double steps) {
    if (!any_free_) return;
    for (std::size_t w = 0; w < count(); ++w) {
        if (!moving_[w].free() || !moving_[w].present()) continue;
        const WallLoad on = load(w, pivot_[w]);
        moving_[w].kick(on.force, on.torque, pivot_[w], time, steps * scale_.time);
    }
}

void Walls::drift() {
    if (!any_free_) return;
    for (MovingWall& wall : moving_)
        if (wall.present()) wall.drift(scale_.time);
}

void Walls::sum_up(bool all) {
    for (std::size_t w = 0; w < count(); ++w) placed_[w].summed = all || moves(w) || integrates(w) ? 1 : 0;
}

void Walls::bound_velocities(double time, bool free, Tally& tally) const {
    if (free && !any_free_) return;
    for (const MovingWall& wall : moving_) {
        if (wall.at_rest() || !wall.present() || wall.free() != free) continue;
        const auto [low, high] = wall.surface_velocities(time, scale_.time);
        for (std::size_t a = 0; a < 3; ++a) {
            tally.velocity_high[a] = std::max(tally.velocity_high[a], static_cast<float>(high[a] / scale_.speed()));
            tally.velocity_low[a] = std::min(tally.velocity_low[a], static_cast<float>(low[a] / scale_.speed()));
        }
    }
}

std::string Walls::too_fast(double smallest_radius, std::int64_t steps) const {
    for (std::size_t w = 0; w < count(); ++w) {
        if (!moving_[w].present()) continue;
        std::string flaw = flaw_of_wall_speed(w, moving_[w].fastest_surface(), scale_.time, smallest_radius, steps);
        if (!flaw.empty()) return flaw;
    }
    return {};
}

double Walls::book(const WallSums* sums, bool of_step) {
    double work = 0;
    for (std::size_t w = 0; w < count(); ++w) {
        sums_[w] = sums[w];
        if (of_step && integrates(w)) {
            const WallLoad on = load(w, pivot_[w]);
            moving_[w].integrate(on.force, on.torque, pivot_[w], scale_.time);
        }
        if (!of_step || !moves(w)) continue;
        work_[w] += sums[w].power;
        work += sums[w].power;
    }
    return work;
}

WallLoad Walls::load(std::size_t w, const Vec3& about) const {
    const double force = scale_.force();
    const WallSums& s = sums_.at(w);
    WallLoad load;
    for (std::size_t a = 0; a < 3; ++a) {
        load.force[a] = -s.force[a] * force;
        load.torque[a] = -s.torque[a] * force * scale_.length;
    }
    load.torque += cross(pivot_[w] - about, load.force);
    load.work = work_[w] * force * scale_.length;
    load.impulse = moving_[w].impulse();
    load.angular_impulse = moving_[w].angular_impulse(about);
    return load;
}

void Walls::save(Writer& archive) const {
    archive.value(count());
    for (const MovingWall& wall : moving_) write_wall(wall.wall(), [&](const auto& value) { archive.value(value); });
    archive.list(sums_);
    archive.list(work_);
    for (const MovingWall& wall : moving_)
        MovingWall::for_each_sum(wall, [&](const auto& value) { archive.value(value); });
}

Walls Walls::restored(Reader& archive, const Domain& domain, const Scale& scale, std::int32_t combination,
                      const ContactTable& table, std::span<const Material> materials) {
    Walls walls(read_walls(archive), domain, scale, combination, table, materials);
    const std::size_t count = walls.count();
    archive.list(walls.sums_);
    archive.list(walls.work_);
    if (walls.sums_.size() != count || walls.work_.size() != count)
        throw std::invalid_argument("the checkpoint holds values that no state has");
    for (MovingWall& wall : walls.moving_) MovingWall::for_each_sum(wall, [&](auto& value) { archive.value(value); });
    return walls;
}

}  // namespace grainsweep::dem::fast
