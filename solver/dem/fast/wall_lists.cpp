#include "solver/dem/fast/wall_lists.hpp"

#include <vector>

#include "solver/dem/fast/residual.hpp"

namespace grainsweep::dem::fast {

namespace {

constexpr std::int32_t none = -1;

/// Mobile particles, their positions and reach, as walls look for them.
struct Mobile {
    std::vector<std::uint32_t> index;
    std::vector<Vec3> position;
    std::vector<double> radius;
    const std::uint8_t* kind;  // of each

    Mobile(const Field& f, const Scale& scale, const Parts& parts) : kind(f.kind) {
        const auto n = static_cast<std::size_t>(f.count);
        position.resize(n);
        radius.resize(n);
        const auto is_mobile = [&](std::int32_t i) { return f.records[i].inverse_mass > 0; };
        const std::vector<std::int32_t> before = parts.counted(f.count, [&](Range range) {
            std::int32_t count = 0;
            for (std::int32_t i = range.begin; i < range.end; ++i) count += is_mobile(i) ? 1 : 0;
            return count;
        });
        index.resize(static_cast<std::size_t>(before.back()));
        parts.run([&](int part) {
            auto at = static_cast<std::size_t>(before[static_cast<std::size_t>(part)]);
            const Range range = parts.share(part, f.count);
            for (std::int32_t i = range.begin; i < range.end; ++i) {
                if (!is_mobile(i)) continue;
                const auto k = static_cast<std::size_t>(i);
                index[at++] = static_cast<std::uint32_t>(i);
                position[k] = position_of(f.records[i], scale);
                radius[k] = static_cast<double>(f.records[i].radius) * scale.length;
            }
        });
    }

    /// Those within `reach` of a wall, in order.
    std::vector<std::uint32_t> near(const MovingWall& wall, double reach, const Parts& parts) const {
        std::vector<std::vector<WallTouch>> within(static_cast<std::size_t>(parts.count()));
        const auto share = [&](int part) { return parts.share(part, static_cast<std::int32_t>(index.size())); };
        parts.run([&](int part) {
            const Range range = share(part);
            const std::span mine(index.begin() + range.begin, index.begin() + range.end);
            wall.find(mine, position, {0, radius}, reach, within[static_cast<std::size_t>(part)]);
        });
        std::vector<std::uint32_t> all;
        for (int part = 0; part < parts.count(); ++part)
            for (const WallTouch& touch : within[static_cast<std::size_t>(part)]) {
                const std::uint32_t i = index[static_cast<std::size_t>(share(part).begin) + touch.entry];
                if (wall.wall().touches(kind[i])) all.push_back(i);
            }
        return all;
    }
};

/// Slots of the old segment by new particle.
std::vector<std::int32_t> slots_by_particle(const Field& f, const Columns& c, const WallSegment& old,
                                            std::span<const Place> old_particle) {
    std::vector<std::int32_t> slot(static_cast<std::size_t>(f.count), none);
    for (std::int32_t k = old.begin; k < old.end; ++k) {
        const std::size_t from = old_particle[static_cast<std::size_t>(k)] / places_per_index;
        const std::int32_t to = c.place[from];
        if (to >= 0) slot[static_cast<std::size_t>(to)] = k;
    }
    return slot;
}

}  // namespace

Vec3 position_of(const Record& record, const Scale& scale) {
    Vec3 x{};
    for (std::size_t a = 0; a < 3; ++a) x[a] = scale.centre[a] + record.position[a] * scale.unit[a];
    return x;
}

Vec3 position_at_walls(const Field& f, std::int32_t particle, const Scale& scale) {
    Vec3 x = position_of(f.records[particle], scale);
    const Residual left = residual_of(f, particle);
    for (std::size_t a = 0; a < 3; ++a) x[a] += static_cast<double>(left.position[a]) * scale.unit[a];
    return x;
}

double radius_at_walls(const Field& f, std::int32_t particle, const Scale& scale) {
    const double dropped = f.residuals != nullptr ? double{f.residuals[particle].position[3]} : 0;
    return (double{f.records[particle].radius} + dropped) * scale.length;
}

void list_wall_contacts(Field& f, Columns& c, const Kernels& kernels, const ListSpace& space, const Walls& walls,
                        bool keep, const Parts& parts) {
    std::int32_t n = 0;
    const std::int32_t old_count = keep ? wall_contacts(f) : 0;
    const std::vector<Place> old_particle(f.wall_particle, f.wall_particle + old_count);
    const Mobile mobile(walls.count() > 0 ? f : Field{}, space.scale, parts);
    const double near = static_cast<double>(space.skin + f.constants.beyond_wall) * (1 + 1e-5) * space.scale.length;
    for (std::size_t w = 0; w < walls.count(); ++w) {
        const WallSegment old = f.segments[w];
        const auto old_slot = slots_by_particle(f, c, keep ? old : WallSegment{}, old_particle);
        const std::int32_t begin = n;
        c.hold_wall_contacts(static_cast<std::size_t>(n) + static_cast<std::size_t>(f.count));
        const auto add = [&](std::size_t particle, std::int32_t from) {
            const auto k = static_cast<std::size_t>(n++);
            c.wall_particle[k] = static_cast<Place>(particle * places_per_index);
            for (int a = 0; a < c.histories; ++a)
                c.wall_history_next[a][k] = from == none ? 0 : c.wall_history[a][static_cast<std::size_t>(from)];
        };
        if (walls.is_single(w) && walls[w].present())
            for (const std::uint32_t i : mobile.near(walls[w], near, parts)) add(i, old_slot[i]);
        while ((n - begin) % kernels.width != 0) add(static_cast<std::size_t>(f.count) + 2, none);
        f.segments[w] = {begin, n};
    }
    for (int a = 0; a < c.histories; ++a) c.wall_history[a].swap(c.wall_history_next[a]);
    c.bind(f);
}

}  // namespace grainsweep::dem::fast
