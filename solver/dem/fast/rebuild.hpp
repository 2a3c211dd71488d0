// Rebuild: sorts particles by cell and makes the lists anew; histories move with their contacts.
#pragma once

#include <span>
#include <vector>

#include "solver/dem/engine.hpp"
#include "solver/dem/fast/columns.hpp"
#include "solver/dem/fast/scale.hpp"

namespace grainsweep::dem::fast {

class Parts;
class Resting;
class Clumps;
class Walls;

/// Space that the lists cover: domain, units and range.
struct ListSpace {
    Domain domain;
    Scale scale;
    float skin;  ///< of the outer list, in largest diameters
};

/// Removes particles beyond open faces and the particles in `ids`, sorts the others by cell, makes the outer list and
/// the wall lists, and moves all histories. The inner list is made by refresh().
/// `resting`: decides anew which particles rest, `steps` steps after the last rebuild; null if no particle may rest.
/// `clumps`: of bodies, whose members leave with them; null if there are none.
/// The number of `parts` does not change the result.
void rebuild(Field& field, Columns& columns, const Kernels& kernels, const ListSpace& space, const Walls& walls,
             std::span<const std::int32_t> ids, Resting* resting, std::int64_t steps, const Parts& parts,
             Clumps* clumps = nullptr, std::size_t ids_so_far = 0);

/// Makes the inner list from the outer list; histories keep their order. `marked`: outer_touching already marks the
/// touching pairs.
void refresh(Field& field, PairColumns& columns, const Kernels& kernels, float skin, bool marked);

/// Writes the records behind the last particle that pad vectors, and the record of a wall; only for the lists of all
/// particles.
void place_fillers(Field& field);

}  // namespace grainsweep::dem::fast
