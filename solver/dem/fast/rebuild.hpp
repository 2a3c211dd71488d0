// Sorting particles by cell and making the lists anew, histories following their contacts.
#pragma once

#include <span>
#include <vector>

#include "solver/dem/engine.hpp"
#include "solver/dem/fast/columns.hpp"
#include "solver/dem/fast/scale.hpp"

namespace grainsweep::dem::fast {

class Parts;
class Resting;
class Walls;

/// The space that lists cover: domain, units and range.
struct ListSpace {
    Domain domain;
    Scale scale;
    float skin;  ///< of the outer list, in largest diameters
};

/// Removes particles beyond open faces and those listed in `ids`, sorts the rest by cell, makes the outer list and
/// the wall lists and carries all histories over. The inner list is left to refresh.
/// `resting`: decides anew which particles rest, `steps` steps after the last rebuild; null where none may. `parts`:
/// their number changes nothing.
void rebuild(Field& field, Columns& columns, const Kernels& kernels, const ListSpace& space, const Walls& walls,
             std::span<const std::int32_t> ids, Resting* resting, std::int64_t steps, const Parts& parts);

/// Makes the inner list from the outer one; histories stay as they are, in the same order.
/// `marked`: outer_touching already says which outer pairs touch.
void refresh(Field& field, PairColumns& columns, const Kernels& kernels, float skin, bool marked);

/// Writes the records behind the last particle that fill vectors up, and the one of any wall; lists are of all.
void place_fillers(Field& field);

}  // namespace grainsweep::dem::fast
