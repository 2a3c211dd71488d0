// The particles in the order of cells, which are no smaller than a listed distance: a counting sort.
#pragma once

#include <span>

#include "solver/dem/fast/columns.hpp"
#include "solver/dem/fast/parts.hpp"
#include "solver/dem/fast/rebuild.hpp"

namespace grainsweep::dem::fast {

/// Marks in `place` which particles stay (0) and which are removed (-1: left through a face, or listed); returns the
/// number that stay.
std::int32_t take_out(const Field& field, Columns& columns, const ListSpace& space, std::span<const std::int32_t> ids,
                      const Parts& parts);

/// Sorts by cell, of equal cells in the order of before, and fills the columns the search reads. place maps old to new
/// indices afterwards.
void sort_particles(Field& field, Columns& columns, const ListSpace& space, std::int32_t kept, const Parts& parts);

}  // namespace grainsweep::dem::fast
