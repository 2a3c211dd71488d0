// Sorting particles by cell and making the lists anew, histories following their contacts.
#pragma once

#include <span>
#include <vector>

#include "solver/dem/engine.hpp"
#include "solver/dem/fast/columns.hpp"
#include "solver/dem/fast/scale.hpp"
#include "solver/dem/walls/moving_wall.hpp"

namespace grainsweep::dem::fast {

class Resting;

/// The space that lists cover: domain, units and range.
struct ListSpace {
    Domain domain;
    Scale scale;
    float skin;  ///< of the outer list, in largest diameters
};

/// Removes particles beyond open faces and those listed in `ids`, sorts the rest by cell, makes the outer list and
/// the wall lists and carries all histories over. The inner list is left to refresh.
/// `resting`: decides anew which particles rest, `steps` steps after the last rebuild; null where none may.
void rebuild(Field& field, Columns& columns, const Kernels& kernels, const ListSpace& space,
             std::span<const std::int32_t> ids, Resting* resting, std::int64_t steps);

/// Makes the inner list from the outer one; histories stay as they are, in the same order.
/// `marked`: outer_touching already says which outer pairs touch.
void refresh(Field& field, Columns& columns, const Kernels& kernels, float skin, bool marked);

/// Lists the particles near each wall. `keep`: histories follow their contacts; else they start at zero.
void list_wall_contacts(Field& field, Columns& columns, const Kernels& kernels, const ListSpace& space, bool keep);

/// Gives the walls the shapes and their records the velocities they have now (engine's units).
void place_walls(Field& field, const std::vector<MovingWall>& walls, const ListSpace& space);

/// Gap between a particle and a wall, largest diameters; never more than the true one.
[[nodiscard]] double wall_gap(const Field& field, const WallShape& wall, std::int32_t particle);

/// Writes the records behind the last particle that fill vectors up.
void place_fillers(Field& field);

}  // namespace grainsweep::dem::fast
