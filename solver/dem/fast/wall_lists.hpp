// Lists of the particles near each wall, one segment per wall; histories move with their contacts.
#pragma once

#include "solver/dem/fast/columns.hpp"
#include "solver/dem/fast/parts.hpp"
#include "solver/dem/fast/rebuild.hpp"
#include "solver/dem/fast/walls.hpp"

namespace grainsweep::dem::fast {

/// Returns the number of entries of the list, including padding.
inline std::int32_t wall_contacts(const Field& f) {
    return f.wall_count > 0 ? f.segments[f.wall_count - 1].end : 0;
}

/// Makes the lists of walls that can be touched in one place only; for other walls see wall_touches.hpp. `keep`:
/// histories move with their contacts, by columns.place; otherwise they start at zero.
void list_wall_contacts(Field& field, Columns& columns, const Kernels& kernels, const ListSpace& space,
                        const Walls& walls, bool keep, const Parts& parts);

/// Calls visit(particle, slot) for the listed particles of a wall. For a wall that can be touched in several places, it
/// visits the touching particles, with the slot of the first contact.
template <class Visit>
void for_each_near(const Field& f, const Walls& walls, std::size_t w, Visit&& visit) {
    const bool single = walls.is_single(w);
    const WallSegment& s = single ? f.segments[w] : f.touched[w];
    const Place* places = single ? f.wall_particle : f.touch_particle;
    for (std::int32_t k = s.begin; k < s.end; ++k) {
        const auto i = static_cast<std::int32_t>(places[k] / places_per_index);
        const bool fills_up = i >= f.count, again = !single && k > s.begin && places[k] == places[k - 1];
        if (!fills_up && !again) visit(i, k);
    }
}

/// Returns the position of a particle in whole units, m.
[[nodiscard]] Vec3 position_of(const Record& record, const Scale& scale);
/// Returns the position that the forces of walls use, m.
[[nodiscard]] Vec3 position_at_walls(const Field& field, std::int32_t particle, const Scale& scale);
/// Returns the radius that the forces of walls use, m.
[[nodiscard]] double radius_at_walls(const Field& field, std::int32_t particle, const Scale& scale);

}  // namespace grainsweep::dem::fast
